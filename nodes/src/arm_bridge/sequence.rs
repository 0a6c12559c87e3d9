//! Tracks sequence numbers of datagrams: new ones, old ones, and how many are missing.

use std::time::{Duration, Instant};

use super::description::SequenceKind;

/// Silence after which a sender may restart at any number: its signals are stale by then, and a restarted instrument begins at
/// zero. Before that, an old number means a late or repeated datagram.
const ANEW: Duration = Duration::from_secs(1);

/// Classification of a datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// The datagram is new; `missing` datagrams between the previous one and this one did not arrive.
    New { missing: u64 },
    /// A duplicate, or older than the newest.
    Old,
}

/// The sequence of one sender.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sequence {
    /// Number of distinct sequence numbers.
    modulus: u64,
    /// Number and time of the newest datagram.
    newest: Option<(u64, Instant)>,
}

impl Sequence {
    /// A sequence before its first datagram.
    pub fn new(kind: SequenceKind) -> Self {
        Sequence { modulus: 1 << (8 * kind.length()), newest: None }
    }

    /// Classifies the datagram `number`, which arrived at `now`. A number is newer than another if it is reached by counting up
    /// less than half of all numbers, with wrap-around (RFC 1982).
    pub fn take(&mut self, number: u64, now: Instant) -> Verdict {
        let missing = match self.newest {
            Some((newest, at)) if now.saturating_duration_since(at) < ANEW => {
                let ahead = number.wrapping_sub(newest) % self.modulus;
                if ahead == 0 || ahead >= self.modulus / 2 {
                    return Verdict::Old;
                }
                ahead - 1
            }
            _ => 0,
        };
        self.newest = Some((number, now));
        Verdict::New { missing }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_rise_wrap_around_and_gaps_are_counted() {
        let now = Instant::now();
        let mut sequence = Sequence::new(SequenceKind::U16);
        let verdicts = [65_533, 65_534, 65_535, 0, 1, 4, 4, 3, 65_535, 5].map(|number| sequence.take(number, now));
        let new = Verdict::New { missing: 0 };
        let old = Verdict::Old;
        assert_eq!(verdicts, [new, new, new, new, new, Verdict::New { missing: 2 }, old, old, old, new]);
    }

    #[test]
    fn a_sender_that_restarts_is_heard_after_a_second_of_silence() {
        let start = Instant::now();
        let mut sequence = Sequence::new(SequenceKind::U32);
        assert_eq!(sequence.take(1_000_000, start), Verdict::New { missing: 0 });
        assert_eq!(sequence.take(0, start + Duration::from_millis(900)), Verdict::Old);
        assert_eq!(sequence.take(1, start + Duration::from_millis(1001)), Verdict::New { missing: 0 });
        assert_eq!(sequence.take(2, start + Duration::from_millis(1002)), Verdict::New { missing: 0 });
    }
}
