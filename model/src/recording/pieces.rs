//! Splits a recording where the clock was set forward or the recorder paused.

use std::borrow::Cow;
use std::ops::Range;

use super::Recording;

/// Sample intervals without a sample after which a new piece begins.
const INTERVALS: f64 = 1000.0;
/// The same in s. Within two seconds an arm comes to rest by itself; after that, its earlier states do not determine its
/// position.
const LEAST: f64 = 2.0;

/// Sample intervals that a simulation may bridge.
const FEW: f64 = 100.0;

impl Recording {
    /// The samples of each piece, in order: pieces are more than 1000 sample intervals, and more than 2 s, apart.
    ///
    /// A clock that is set forward by a year leaves a gap of a year between two samples. Nothing is known about that time, so
    /// no method may bridge it.
    pub fn pieces(&self) -> Vec<Range<usize>> {
        self.pieces_apart(longest_gap(self.sample_interval()))
    }

    /// The samples of each piece for a machine that forgets its state within `memory` s: pieces are further apart than that, and more
    /// than a hundred sample intervals, between which the inputs may be interpolated.
    pub fn pieces_after(&self, memory: f64) -> Vec<Range<usize>> {
        let few = FEW * self.sample_interval();
        self.pieces_apart(if few.is_finite() { memory.max(few) } else { memory })
    }

    fn pieces_apart(&self, longest: f64) -> Vec<Range<usize>> {
        let mut pieces = Vec::new();
        let mut first = 0;
        for index in 1..=self.len() {
            if index == self.len() || self.time[index] - self.time[index - 1] > longest {
                pieces.push(first..index);
                first = index;
            }
        }
        pieces
    }

    /// Total time of all pieces, s: a clock that is set forward adds nothing.
    pub fn recorded_time(&self) -> f64 {
        self.pieces().iter().map(|piece| self.time[piece.end - 1] - self.time[piece.start]).sum()
    }
}

/// Median time between samples at the times `time`, s; `NaN` for fewer than two.
pub fn median_interval(time: &[f64]) -> f64 {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.is_empty() {
        return f64::NAN;
    }
    let middle = steps.len() / 2;
    *steps.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Longest time between two samples of one piece, s, for this sample interval.
pub fn longest_gap(interval: f64) -> f64 {
    if interval.is_finite() { LEAST.max(INTERVALS * interval) } else { LEAST }
}

/// A clock on which no gap is longer than [`longest_gap`] for this interval: later samples are moved forward. For methods
/// whose work grows with the length of a recording.
pub fn closed_gaps(time: &[f64], interval: f64) -> Cow<'_, [f64]> {
    let longest = longest_gap(interval);
    if time.windows(2).all(|pair| pair[1] - pair[0] <= longest) {
        return Cow::Borrowed(time);
    }
    let mut excess = 0.0;
    let mut closed = Vec::with_capacity(time.len());
    closed.extend(time.first());
    for pair in time.windows(2) {
        excess += (pair[1] - pair[0] - longest).max(0.0);
        closed.push(pair[1] - excess);
    }
    Cow::Owned(closed)
}

#[cfg(test)]
#[allow(clippy::single_range_in_vec_init)]
mod tests {
    use super::*;

    fn stepped(gap: f64) -> Recording {
        let time = (0..1000).map(|index| f64::from(index) * 0.002 + if index < 400 { 0.0 } else { gap }).collect();
        Recording::unmeasured("bag", time, &[])
    }

    #[test]
    fn a_clock_that_is_set_forward_cuts() {
        assert_eq!(stepped(1.9).pieces(), vec![0..1000]);
        assert_eq!(stepped(2.1).pieces(), [0..400, 400..1000]);
        assert_eq!(stepped(1e9).pieces(), [0..400, 400..1000]);
        assert_eq!(Recording::default().pieces(), []);
        assert_eq!(Recording::unmeasured("bag", vec![0.0], &[]).pieces(), vec![0..1]);
    }

    #[test]
    fn a_fast_machine_forgets_within_a_shorter_pause() {
        let recording = stepped(1.0);
        assert_eq!(recording.pieces(), [0..1000]);
        assert_eq!(recording.pieces_after(0.4), [0..400, 400..1000]);
        assert_eq!(recording.pieces_after(1.5), [0..1000]);
        assert_eq!(stepped(0.15).pieces_after(0.01), [0..1000], "few samples are lost");
    }

    #[test]
    fn closed_gaps_are_as_long_as_a_gap_may_be() {
        let recording = stepped(1e9);
        let closed = closed_gaps(&recording.time, recording.sample_interval());
        assert!((closed[400] - closed[399] - 2.0).abs() < 1e-6, "{}", closed[400] - closed[399]);
        assert!((closed[999] - closed[400] - 599.0 * 0.002).abs() < 1e-6);
        assert!(matches!(closed_gaps(&stepped(1.0).time, 0.002), Cow::Borrowed(_)));
    }
}
