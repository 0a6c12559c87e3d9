//! Detects messages that differ from an earlier one only in their stamp and numbers.
//!
//! On a topic of a machine, this applies to every message but the first: names, lengths and positions repeat. Comparing
//! them with the first costs a tenth of decoding them again.

use std::ops::Range;

use excavator_msgs::Time;

use super::content::ENCAPSULATION;

/// The header is the first field of a message, and the stamp is the first field of the header.
const STAMP: Range<usize> = ENCAPSULATION..ENCAPSULATION + size_of::<i32>() + size_of::<u32>();

/// A message that was fully decoded, and the positions of its numbers.
#[derive(Debug, Default)]
pub(super) struct Shape {
    message: Vec<u8>,
    /// Ranges of consecutive 8-byte numbers, bytes from the start of the message; ascending.
    runs: Vec<Range<usize>>,
}

/// Stamp and numbers of a message of a known shape.
#[derive(Debug, Clone, Copy)]
pub(super) struct Numbers<'m> {
    message: &'m [u8],
    runs: &'m [Range<usize>],
}

impl Shape {
    /// Sets the message to compare with; `runs` as in [`Shape`], all within the message.
    pub fn learn(&mut self, message: &[u8], runs: &[Range<usize>]) {
        self.forget();
        self.message.extend_from_slice(message);
        self.runs.extend_from_slice(runs);
    }

    /// After this, no message has this shape.
    pub fn forget(&mut self) {
        self.message.clear();
        self.runs.clear();
    }

    /// The numbers of a message; `None` if it differs in anything else.
    pub fn numbers<'m>(&'m self, message: &'m [u8]) -> Option<Numbers<'m>> {
        if message.len() != self.message.len() || message.is_empty() {
            return None;
        }
        let mut fixed_from = STAMP.end;
        let same = |range: Range<usize>| message.get(range.clone()) == self.message.get(range);
        if !same(0..STAMP.start) {
            return None;
        }
        for run in &self.runs {
            if !same(fixed_from..run.start) {
                return None;
            }
            fixed_from = run.end;
        }
        // Only padding follows the last number.
        Some(Numbers { message, runs: &self.runs })
    }
}

impl<'m> Numbers<'m> {
    /// The stamp in the header, ns since the epoch.
    pub fn stamp(&self) -> i64 {
        let stamp: Option<[u8; 8]> = self.message.get(STAMP).and_then(|bytes| bytes.try_into().ok());
        let [a, b, c, d, e, f, g, h] = stamp.unwrap_or_default();
        Time { sec: i32::from_le_bytes([a, b, c, d]), nanosec: u32::from_le_bytes([e, f, g, h]) }.nanoseconds()
    }

    /// All numbers in the order of the message.
    pub fn values(self) -> impl Iterator<Item = f64> + 'm {
        let run = |range: &Range<usize>| self.message.get(range.clone()).unwrap_or_default().as_chunks::<8>().0;
        self.runs.iter().flat_map(run).map(|&bytes| f64::from_le_bytes(bytes))
    }
}
