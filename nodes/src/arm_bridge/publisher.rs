//! Publishes states, and reports their health.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use excavator_msgs::common::JointState;
use excavator_msgs::{ArmState, Time};

use super::frame_counts::Counts;
use super::signals::{Fault, Signals};
use crate::arm_state::joint_state;
use excavator_ros::{Diagnostics, Health, Lifecycle, Outlet, Pace, RosClock};

/// Time between two diagnostics messages.
const REPORT: Duration = Duration::from_millis(200);
/// Rate of `/joint_states`, Hz.
const JOINT_STATES_RATE: f64 = 50.0;
/// Pause while readers cannot keep up with a log that is read as fast as possible.
#[cfg(feature = "can")]
const READERS_BEHIND: Duration = Duration::from_millis(1);

pub(super) fn lock(signals: &Mutex<Signals>) -> MutexGuard<'_, Signals> {
    signals.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Datagrams and frames that were not used.
#[derive(Debug, Default)]
pub(super) struct Refused {
    /// Datagrams of another length than described.
    pub datagrams: AtomicU64,
    /// Datagrams of senders that the description does not name.
    pub strangers: AtomicU64,
    /// Datagrams of a second sender where the description names none.
    pub others: AtomicU64,
    /// Datagrams whose sequence number was a duplicate, or older than the newest.
    pub repeated: AtomicU64,
    /// Sequence numbers that never arrived.
    pub missing: AtomicU64,
    /// CAN frames.
    pub frames: Counts,
}

/// Publishes states.
pub(super) struct Publisher<'p> {
    pub rate: f64,
    /// Frame in the headers of states.
    pub frame: String,
    pub signals: &'p Mutex<Signals>,
    pub states: Outlet<ArmState>,
    /// `None` if the bridge itself reads `/joint_states`, so that it does not receive its own messages.
    pub joints: Option<Outlet<JointState>>,
    pub lifecycle: &'p Lifecycle,
    pub clock: &'p RosClock,
    pub diagnostics: &'p Diagnostics,
    pub refused: &'p Refused,
    /// Whether CAN buses are read.
    pub has_frames: bool,
    /// Whether datagrams are read.
    pub has_datagrams: bool,
}

impl Publisher<'_> {
    /// Publishes at the set rate until `stop` is set.
    pub fn run(&self, stop: &AtomicBool) {
        let mut pace = Pace::new(self.rate);
        let mut reported: Option<Instant> = None;
        for round in 0_u64.. {
            if stop.load(Ordering::Relaxed) {
                return;
            }
            let now = Instant::now();
            let faults = self.publish(round, self.clock.nanoseconds(), now, |states, state| {
                // The outlet counts refusals; they are reported below.
                let _ = states.publish(state);
            });
            if reported.is_none_or(|reported| reported.elapsed() >= REPORT) {
                reported = Some(now);
                self.report(&faults);
            }
            pace.wait();
        }
    }

    /// Publishes the state of a moment as soon as readers can take it. Gives up if `stop` is set.
    #[cfg(feature = "can")]
    pub fn publish_when_possible(&self, round: u64, nanoseconds: i64, moment: Instant, stop: &AtomicBool) {
        let faults = self.publish(round, nanoseconds, moment, |states, state| {
            while !stop.load(Ordering::Relaxed)
                && states.publish(state.clone()) == Err(excavator_ros::PublishError::Full)
            {
                std::thread::sleep(READERS_BEHIND);
            }
        });
        if round.is_multiple_of(1000) {
            self.report(&faults);
        }
    }

    fn publish(
        &self,
        round: u64,
        nanoseconds: i64,
        moment: Instant,
        send: impl FnOnce(&Outlet<ArmState>, ArmState),
    ) -> Vec<(usize, Fault)> {
        let (mut state, faults) = {
            let mut signals = lock(self.signals);
            let delay = i64::try_from(signals.delay().as_nanos()).unwrap_or_default();
            let stamp = Time::from_nanoseconds(nanoseconds.saturating_sub(delay)).unwrap_or_default();
            signals.state(stamp, moment)
        };
        let joints_every = ((self.rate / JOINT_STATES_RATE).round() as u64).max(1);
        if !self.lifecycle.is_active() {
            return faults;
        }
        if let Some(joints) = &self.joints
            && round.is_multiple_of(joints_every)
        {
            // The next one comes within a fiftieth of a second.
            let _ = joints.publish(joint_state(&state, Vec::new()));
        }
        state.header.frame_id.clone_from(&self.frame);
        send(&self.states, state);
        faults
    }

    fn report(&self, faults: &[(usize, Fault)]) {
        let words: Vec<(String, String)> = faults
            .iter()
            .map(|(index, fault)| {
                let word = match fault {
                    Fault::Never => "never came".to_string(),
                    Fault::Stale(age) => format!("stale for {age:.2} s"),
                    Fault::OutOfRange(value) => format!("out of range: {value}"),
                };
                (lock(self.signals).name(*index).to_string(), word)
            })
            .collect();
        let mut values: Vec<(&str, String)> = words.iter().map(|(name, word)| (name.as_str(), word.clone())).collect();
        let count = |counter: &AtomicU64| counter.load(Ordering::Relaxed).to_string();
        values.push(("refused datagrams", count(&self.refused.datagrams)));
        if self.has_datagrams {
            values.push(("datagrams of other senders", count(&self.refused.strangers)));
            values.push(("datagrams of a second sender", count(&self.refused.others)));
            values.push(("repeated or old datagrams", count(&self.refused.repeated)));
            values.push(("missing datagrams", count(&self.refused.missing)));
        }
        if self.has_frames {
            let frames = &self.refused.frames;
            values.push(("frames of a second sender", count(&frames.others)));
            values.push(("short frames", count(&frames.short)));
            values.push(("error and remote frames", count(&frames.without_data)));
            values.push(("unreadable lines", count(&frames.unreadable)));
        }
        values.push(("refused states", self.states.refused().to_string()));
        let names: Vec<&str> = words.iter().map(|(name, _)| name.as_str()).collect();
        let second = self.refused.others.load(Ordering::Relaxed) + self.refused.frames.others.load(Ordering::Relaxed);
        let (health, message) = match names.as_slice() {
            [] if second > 0 => {
                let text =
                    format!("two senders of one source: the first is used, {second} messages of others are left out");
                (Health::Warning, text)
            }
            [] => (Health::Ok, "all signals are measured".to_string()),
            names => (Health::Warning, format!("not measured: {}", names.join(", "))),
        };
        self.diagnostics.tell("signals", health, message, &values);
    }
}
