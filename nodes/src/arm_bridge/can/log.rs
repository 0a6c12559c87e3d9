//! Reads a log of `candump -L` in place of a device.

use std::io::{BufRead, BufReader, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

use socketcan::dump::{ParseError, Reader};

use super::{Counts, Frame};

/// Longest pause, µs. A longer one counts as a jump of the logging clock, and is shortened to [`PAUSE`].
const LONGEST_PAUSE: u64 = 60_000_000;
/// Pause that replaces a jump, µs: longer than values stay valid.
const PAUSE: u64 = 1_000_000;
/// Drivers may deliver frames out of order by up to this time, µs, and the log keeps that order.
const DISORDER: u64 = 1_000_000;

/// A readable log.
#[derive(Debug)]
pub(in crate::arm_bridge) struct Log {
    path: PathBuf,
    /// If set, only frames of this device are read.
    channel: Option<String>,
}

/// A frame of a log.
#[derive(Debug, PartialEq)]
pub(in crate::arm_bridge) struct Logged {
    /// Time since the first frame, without jumps of the clock.
    pub elapsed: Duration,
    /// The log's own clock, µs.
    pub stamp: u64,
    /// Whether the clock jumped since the previous frame.
    pub jumped: bool,
    /// The frame.
    pub frame: Frame,
}

impl Log {
    /// Checks that the file can be opened.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn open(path: &Path, channel: Option<String>) -> Result<Self, String> {
        std::fs::File::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
        Ok(Log { path: path.to_path_buf(), channel })
    }

    /// Its data frames. Other records are counted.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn frames<'c>(&'c self, counts: &'c Counts) -> Result<impl Iterator<Item = Logged> + 'c, String> {
        let file = std::fs::File::open(&self.path).map_err(|error| format!("{}: {error}", self.path.display()))?;
        Ok(frames(BufReader::new(file), self.channel.as_deref(), counts))
    }
}

/// Data frames of the text of a log.
pub(super) fn frames<'c>(
    text: impl BufRead + 'c,
    channel: Option<&'c str>,
    counts: &'c Counts,
) -> impl Iterator<Item = Logged> + 'c {
    let mut clock = Clock::default();
    let mut reader = Reader::from_reader(text);
    std::iter::from_fn(move || {
        loop {
            let record = match reader.next_record() {
                Ok(None) => return None,
                // A read error would repeat for ever, so it ends the log. A line that is not text counts as unreadable, like
                // any other faulty line.
                Err(ParseError::Io(error)) if error.kind() != ErrorKind::InvalidData => return None,
                Err(_) => {
                    counts.unreadable.fetch_add(1, Ordering::Relaxed);
                    continue;
                }
                Ok(Some(record)) => record,
            };
            if channel.is_some_and(|channel| channel != record.device) {
                continue;
            }
            let Some(frame) = Frame::of(&record.frame) else {
                counts.without_data.fetch_add(1, Ordering::Relaxed);
                continue;
            };
            let jumped = clock.advance(record.t_us);
            return Some(Logged { elapsed: Duration::from_micros(clock.elapsed), stamp: record.t_us, jumped, frame });
        }
    })
}

/// The clock of a log, without its jumps.
#[derive(Debug, Default)]
struct Clock {
    last: Option<u64>,
    elapsed: u64,
}

impl Clock {
    /// Advances to `stamp`, µs. Returns whether this is a jump.
    fn advance(&mut self, stamp: u64) -> bool {
        let last = self.last.unwrap_or(stamp);
        let jumped = stamp.saturating_sub(last) > LONGEST_PAUSE || last.saturating_sub(stamp) > DISORDER;
        let step = if jumped { PAUSE } else { stamp.saturating_sub(last) };
        self.elapsed = self.elapsed.saturating_add(step);
        self.last = Some(if jumped { stamp } else { last.max(stamp) });
        jumped
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, channel: Option<&str>) -> (Vec<Logged>, Counts) {
        let counts = Counts::default();
        let found = frames(text.as_bytes(), channel, &counts).collect();
        (found, counts)
    }

    #[test]
    fn frames_of_one_device_are_read_and_nonsense_is_counted() {
        let text = "(1700000000.000000) can0 123#0102\nnonsense\n(1700000000.010000) can1 123#03\n\
                    (1700000000.020000) can0 18FEF100#0A0B R\n(1700000000.030000) can0 123#R\n\
                    (1700000000.040000) can0 20000004#000C000000000000\n(1700000000.050000) can0 123##1DEADBEEF\n";
        let (found, counts) = read(text, Some("can0"));
        let data: Vec<&[u8]> = found.iter().map(|logged| logged.frame.data.as_slice()).collect();
        assert_eq!(data, [&[1, 2][..], &[10, 11], &[0xde, 0xad, 0xbe, 0xef]]);
        assert!(found[1].frame.identifier.extended && !found[0].frame.identifier.extended);
        assert_eq!(found[2].elapsed, Duration::from_millis(50));
        assert_eq!((counts.unreadable.into_inner(), counts.without_data.into_inner()), (1, 2));
    }

    #[test]
    fn a_clock_that_jumps_does_not_stop_the_log() {
        let text = "(1.000000) can0 123#01\n(4000000000.000000) can0 123#02\n(4000000000.100000) can0 123#03\n\
                    (2.000000) can0 123#04\n(1.999000) can0 123#05\n";
        let (found, _) = read(text, None);
        let elapsed: Vec<u128> = found.iter().map(|logged| logged.elapsed.as_millis()).collect();
        assert_eq!(elapsed, [0, 1000, 1100, 2100, 2100]);
        assert_eq!(found.iter().map(|logged| logged.jumped).collect::<Vec<_>>(), [false, true, false, true, false]);
    }
}
