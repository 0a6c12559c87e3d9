//! Datagrams by their number: which is new, which is not, how many are missing.

use std::time::{Duration, Instant};

use super::description::SequenceKind;

/// Silence after which a sender may begin anew at any number: signals are stale by then, and a restarted instrument begins
/// at zero. Within it, an old number is a late or a repeated datagram.
const ANEW: Duration = Duration::from_secs(1);

/// What becomes of a datagram.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Verdict {
    /// It is new; so many between the one before and it did not come.
    New { missing: u64 },
    /// It came before, or is older than the newest.
    Old,
}

/// The numbers of one sender.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sequence {
    /// Count of different numbers.
    modulus: u64,
    /// Number and time of the newest datagram.
    newest: Option<(u64, Instant)>,
}

impl Sequence {
    /// Nothing has come.
    pub fn new(kind: SequenceKind) -> Self {
        Sequence { modulus: 1 << (8 * kind.length()), newest: None }
    }

    /// A datagram with the number `number` came at `now`. Of two numbers the one is newer that is reached from the other by
    /// counting less than half of all numbers upwards, past the largest if need be (RFC 1982).
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
