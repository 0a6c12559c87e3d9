//! Limits the rate of log lines about refusals.

use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::printable::printable;
use excavator_ros::Logger;

/// Shortest time between two lines.
const LEAST: Duration = Duration::from_secs(2);

/// Counts refusals, and logs some of them.
#[derive(Debug, Default, Clone, Copy)]
pub(super) struct Refusals {
    total: u64,
    unsaid: u64,
    said: Option<Instant>,
}

impl Refusals {
    /// No refusals yet.
    pub const fn new() -> Self {
        Refusals { total: 0, unsaid: 0, said: None }
    }

    /// Counts a refusal. Returns the line to log if one is due.
    pub fn take(&mut self, reason: &str, now: Instant) -> Option<String> {
        self.total += 1;
        if self.said.is_some_and(|said| now.saturating_duration_since(said) < LEAST) {
            self.unsaid += 1;
            return None;
        }
        self.said = Some(now);
        let others = std::mem::take(&mut self.unsaid);
        Some(if others == 0 {
            reason.to_string()
        } else {
            format!("{reason} ({others} more goals since the last line)")
        })
    }

    /// As [`Refusals::take`], and logs the line.
    pub fn log(&mut self, logger: &Logger, reason: &str) {
        if let Some(line) = self.take(reason, Instant::now()) {
            logger.warn(line);
        }
    }

    /// Number of refusals so far.
    pub fn total(&self) -> u64 {
        self.total
    }
}

/// Reports a fault in a file on the console, which belongs to the operator. The text may quote the file, so it goes neither to
/// the client nor to `/rosout`.
pub(super) fn tell_operator(text: &str) {
    static SAID: Mutex<Refusals> = Mutex::new(Refusals::new());
    let line = SAID.lock().unwrap_or_else(PoisonError::into_inner).take(text, Instant::now());
    line.iter().for_each(|line| remark(line));
}

/// Prints a remark on a recording on the console. It may quote the file, as in [`tell_operator`].
pub(super) fn remark(text: &str) {
    eprintln!("{}", printable(text, 1000));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_of_refusals_is_a_line_every_two_seconds() {
        let start = Instant::now();
        let mut refusals = Refusals::default();
        let lines: Vec<String> =
            (0..500).filter_map(|number| refusals.take("no", start + Duration::from_millis(10 * number))).collect();
        assert_eq!(lines.len(), 3, "{lines:?}");
        assert_eq!(lines[1], "no (199 more goals since the last line)");
        assert_eq!(refusals.total(), 500);
    }
}
