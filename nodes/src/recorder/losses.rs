//! Counts lost messages by the sequence numbers of the publishers.

use std::collections::HashMap;

/// Messages of each publisher of one topic.
#[derive(Debug, Default)]
pub(super) struct Losses {
    last: HashMap<[u8; 16], i64>,
    lost: u64,
    late: u64,
    /// Time at which the last message was received, ns.
    received: Option<u64>,
    /// Longest time between two messages, ns.
    silence: u64,
}

impl Losses {
    /// Records message `sequence` of `writer`, received at `received` (ns). Messages that a publisher sent before we subscribed
    /// do not count as lost.
    pub fn take(&mut self, writer: [u8; 16], sequence: i64, received: u64) {
        let since = self.received.map_or(0, |last| received.saturating_sub(last));
        self.silence = self.silence.max(since);
        self.received = Some(received);
        let last = self.last.entry(writer).or_insert(sequence - 1);
        match sequence - *last {
            step @ 1.. => {
                self.lost += u64::try_from(step - 1).unwrap_or_default();
                *last = sequence;
            }
            // It was counted as lost when a later message arrived before it.
            _ => {
                self.late += 1;
                self.lost = self.lost.saturating_sub(1);
            }
        }
    }

    /// Messages that were published while we were subscribed, and did not arrive.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Longest time between two messages, s. A publisher that was unreachable for long comes back as a new one, whose sequence
    /// numbers do not show what was missed.
    pub fn longest_silence(&self) -> f64 {
        self.silence as f64 * 1e-9
    }

    /// Number of publishers that sent messages.
    pub fn publishers(&self) -> usize {
        self.last.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A: [u8; 16] = [1; 16];
    const B: [u8; 16] = [2; 16];

    #[test]
    fn gaps_are_counted_per_publisher() {
        let mut losses = Losses::default();
        for (writer, sequence) in [(A, 100), (A, 101), (B, 1), (A, 104), (B, 2)] {
            losses.take(writer, sequence, 0);
        }
        assert_eq!((losses.lost(), losses.publishers()), (2, 2));
    }

    #[test]
    fn the_longest_silence_is_kept() {
        let mut losses = Losses::default();
        for (sequence, received) in [(1, 1_000_000_000), (2, 1_500_000_000), (3, 4_000_000_000), (4, 4_100_000_000)] {
            losses.take(A, sequence, received);
        }
        assert_eq!(losses.longest_silence(), 2.5);
    }

    #[test]
    fn what_comes_late_is_not_lost() {
        let mut losses = Losses::default();
        for sequence in [1, 2, 4, 3, 5] {
            losses.take(A, sequence, 0);
        }
        assert_eq!(losses.lost(), 0);
    }
}
