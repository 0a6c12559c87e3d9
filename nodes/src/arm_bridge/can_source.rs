//! The thread that reads a CAN bus, or a log in its place.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use super::can::{Database, Device, Log, Wanted};
use super::description::{Can, LogPace};
use super::publisher::{Publisher, Refused, lock};
use super::signals::{Signals, Treatment};
use excavator_ros::Logger;

/// Longest sleep between two checks of the stop flag.
const GLANCE: Duration = Duration::from_millis(20);

/// A CAN bus as a source of signals.
pub(super) struct CanSource {
    wanted: Wanted,
    /// Index of its first signal.
    first: usize,
    input: Input,
}

enum Input {
    Device(Device),
    Log(Log, LogPace),
}

impl CanSource {
    /// Opens the described device or log. `treatments` are those of its signals; their ranges are narrowed to those of the DBC
    /// file.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn open(can: &Can, first: usize, treatments: &mut [Treatment]) -> Result<Self, String> {
        let database = Database::read(&can.dbc)?;
        let failed = |reason: String| format!("{}: {reason}", can.dbc.display());
        let mut places = Vec::new();
        for (signal, treatment) in can.signals.iter().zip(treatments) {
            let place = database.place(&signal.message, &signal.name).map_err(failed)?;
            if let Some((least, largest)) = place.range() {
                treatment.narrow(least, largest);
                treatment.check().map_err(failed)?;
            }
            places.push(place);
        }
        let wanted = Wanted::new(places);
        let input = match (&can.device, &can.log) {
            (Some(name), _) => Input::Device(Device::open(name, &wanted)?),
            (None, Some(log)) => Input::Log(Log::open(log, can.channel.clone())?, can.pace),
            (None, None) => return Err("a [[can]] needs either a device or a log".to_string()),
        };
        Ok(CanSource { wanted, first, input })
    }

    /// Whether this source publishes the states itself, because its log is the clock.
    pub fn is_the_clock(&self) -> bool {
        matches!(self.input, Input::Log(_, LogPace::Fastest))
    }

    /// Reads until the end of the log, or until `stop` is set.
    pub fn run(self, publisher: &Publisher<'_>, refused: &Refused, logger: &Logger, stop: &AtomicBool) {
        let CanSource { wanted, first, input } = self;
        let counts = &refused.frames;
        let outcome = match input {
            Input::Device(device) => {
                device.listen(stop, counts, |frame, at| {
                    wanted.read(&frame, at, counts, |index, value| {
                        lock(publisher.signals).take(first + index, value, at)
                    });
                });
                Ok(())
            }
            Input::Log(log, LogPace::Stamps) => {
                follow(&log, &wanted, first, publisher.signals, refused, stop).map(|frames| {
                    logger.info(format!("the log has ended after {frames} frames"));
                })
            }
            Input::Log(log, LogPace::Fastest) => {
                convert(&log, &wanted, first, publisher, refused, stop).map(|states| {
                    logger.info(format!("the log has ended, {states} states were published"));
                    stop.store(true, Ordering::Relaxed);
                })
            }
        };
        if let Err(reason) = outcome {
            logger.error(reason);
        }
    }
}

/// Takes each frame of a log when it is due.
fn follow(
    log: &Log,
    wanted: &Wanted,
    first: usize,
    signals: &Mutex<Signals>,
    refused: &Refused,
    stop: &AtomicBool,
) -> Result<u64, String> {
    let counts = &refused.frames;
    let start = Instant::now();
    let mut frames = 0;
    for logged in log.frames(counts)? {
        let due = start + logged.elapsed;
        while !stop.load(Ordering::Relaxed) {
            let left = due.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            std::thread::sleep(left.min(GLANCE));
        }
        if stop.load(Ordering::Relaxed) {
            break;
        }
        frames += 1;
        // As on a bus, a frame has arrived when it was due, not when this thread woke up.
        wanted.read(&logged.frame, due, counts, |index, value| lock(signals).take(first + index, value, due));
    }
    Ok(frames)
}

/// Publishes the states of a whole log with the stamps of the log.
fn convert(
    log: &Log,
    wanted: &Wanted,
    first: usize,
    publisher: &Publisher<'_>,
    refused: &Refused,
    stop: &AtomicBool,
) -> Result<u64, String> {
    let counts = &refused.frames;
    let period = Duration::try_from_secs_f64(1.0 / publisher.rate).unwrap_or(Duration::from_secs(1));
    let start = Instant::now();
    let mut round = 0_u64;
    // Time of the next state: since the first frame, and on the log's clock, ns.
    let (mut due, mut stamp) = (Duration::ZERO, None::<i64>);
    for logged in log.frames(counts)? {
        let now = i64::try_from(logged.stamp.saturating_mul(1000)).unwrap_or(i64::MAX);
        if logged.jumped || stamp.is_none() {
            (due, stamp) = (logged.elapsed, Some(now));
        }
        while due < logged.elapsed && !stop.load(Ordering::Relaxed) {
            let at = stamp.get_or_insert(now);
            publisher.publish_when_possible(round, *at, start + due, stop);
            *at = at.saturating_add(i64::try_from(period.as_nanos()).unwrap_or(i64::MAX));
            due += period;
            round += 1;
        }
        if stop.load(Ordering::Relaxed) {
            break;
        }
        let at = start + logged.elapsed;
        wanted.read(&logged.frame, at, counts, |index, value| lock(publisher.signals).take(first + index, value, at));
    }
    Ok(round)
}
