//! Counts refusals and other events of the gate, and limits the log to one line per cause.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use super::refusal::Refusal;
use super::writer::Writer;

/// Time after the last refusal for which it is shown as a warning.
const SHOWN: Duration = Duration::from_secs(5);
/// Time without a cause after which it is logged again when it comes back.
const FORGOTTEN: Duration = Duration::from_secs(10);
/// Most distinct causes; the network may cause any number.
const MOST_CAUSES: usize = 64;

/// Counters, and lines to be logged.
#[derive(Debug, Default)]
pub(super) struct Report {
    accepted: u64,
    refused: BTreeMap<&'static str, u64>,
    last_refusal: Option<(Instant, String)>,
    causes: BTreeMap<String, Instant>,
    lines: Vec<String>,
}

impl Report {
    /// Counts a command that was followed.
    pub fn accept(&mut self) {
        self.accepted += 1;
    }

    /// Counts a command that was refused.
    pub fn refuse(&mut self, refusal: &Refusal, writer: &Writer, now: Instant) {
        *self.refused.entry(refusal.kind()).or_default() += 1;
        self.last_refusal = Some((now, format!("command refused: {refusal}")));
        let cause = format!("{} {:02x?}", refusal.kind(), writer.guid);
        self.say_once(cause, || format!("command of {} refused: {refusal}", writer.name()), now);
    }

    /// Queues a line for the log, unless its cause has persisted since the last one.
    pub fn say_once(&mut self, cause: String, line: impl FnOnce() -> String, now: Instant) {
        self.causes.retain(|_, last| now.saturating_duration_since(*last) < FORGOTTEN);
        if self.causes.len() >= MOST_CAUSES && !self.causes.contains_key(&cause) {
            return;
        }
        if self.causes.insert(cause, now).is_none() {
            self.lines.push(line());
        }
    }

    /// Removes and returns the queued lines.
    pub fn take_lines(&mut self) -> Vec<String> {
        std::mem::take(&mut self.lines)
    }

    /// Number of commands that were followed.
    pub fn accepted(&self) -> u64 {
        self.accepted
    }

    /// The last refusal, while it is recent.
    pub fn recent_refusal(&self, now: Instant) -> Option<&str> {
        let (at, text) = self.last_refusal.as_ref()?;
        (now.saturating_duration_since(*at) < SHOWN).then_some(text)
    }

    /// Number of refusals, in total and per kind.
    pub fn refused(&self) -> (u64, impl Iterator<Item = (&'static str, u64)>) {
        (self.refused.values().sum(), self.refused.iter().map(|(kind, count)| (*kind, *count)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cause_is_said_once_and_a_refusal_clears_itself() {
        let start = Instant::now();
        let (mut report, writer) = (Report::default(), Writer::default());
        for millisecond in 0..20_000_u64 {
            report.refuse(&Refusal::Unstamped, &writer, start + Duration::from_millis(millisecond));
        }
        assert_eq!(report.take_lines().len(), 1);
        let end = start + Duration::from_secs(20);
        assert!(report.recent_refusal(end).is_some_and(|text| text.contains("no stamp")));
        assert_eq!(report.recent_refusal(end + SHOWN), None);
        report.refuse(&Refusal::Unstamped, &writer, end + 2 * FORGOTTEN);
        assert_eq!(report.take_lines().len(), 1);
        assert_eq!(report.refused().0, 20_001);
    }

    #[test]
    fn many_strangers_do_not_fill_the_log() {
        let (mut report, now) = (Report::default(), Instant::now());
        for number in 0..1000_u16 {
            let mut writer = Writer::default();
            writer.guid[..2].copy_from_slice(&number.to_be_bytes());
            report.refuse(&Refusal::Unstamped, &writer, now);
        }
        assert_eq!(report.take_lines().len(), MOST_CAUSES);
        assert_eq!(report.refused().0, 1000);
    }
}
