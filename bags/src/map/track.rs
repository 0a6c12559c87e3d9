//! The values of one signal, each with its time.

use excavator_model::recording::spikes;

/// Neighbours of a value are at most this many median intervals away.
const NEAR: f64 = 3.0;

/// Values sorted by stamp, without duplicate stamps.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Track {
    /// ns since the epoch, ascending.
    stamps: Vec<i64>,
    values: Vec<f64>,
    /// Values left out because an earlier one has the same stamp and is different.
    differing: u64,
}

impl Track {
    /// Sorts the values; of those with equal stamps the first one is used. A second publisher answers the first more often
    /// than the other way round.
    pub fn new(mut samples: Vec<(i64, f64)>) -> Track {
        samples.sort_by_key(|&(stamp, _)| stamp);
        let mut track = Track::default();
        for (stamp, value) in samples {
            match track.values.last() {
                Some(&first) if track.stamps.last() == Some(&stamp) => {
                    track.differing += u64::from(first != value && !(first.is_nan() && value.is_nan()));
                }
                _ => {
                    track.stamps.push(stamp);
                    track.values.push(value);
                }
            }
        }
        track
    }

    /// Median interval between values, ns; `None` for fewer than two.
    pub fn median_interval(&self) -> Option<f64> {
        let mut steps: Vec<i64> = self.stamps.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
        let middle = steps.len().checked_sub(1)? / 2;
        Some(*steps.select_nth_unstable(middle).1 as f64)
    }

    /// The sample at this index.
    pub fn get(&self, place: usize) -> Option<(i64, f64)> {
        self.stamps.get(place).copied().zip(self.values.get(place).copied())
    }

    /// Number of values that differ from an earlier one with the same stamp, and were left out.
    pub fn differing(&self) -> u64 {
        self.differing
    }

    /// Leaves out single values that jump away and back, and returns these with their stamps. `longest` is the interval in
    /// ns up to which the signal cannot do so between two samples.
    pub fn leave_out_spikes(&mut self, longest: f64) -> Vec<(i64, f64)> {
        let Some(interval) = self.median_interval().filter(|interval| *interval <= longest) else {
            return Vec::new();
        };
        // Beyond a gap the signal may have moved.
        let is_near = |index: usize| {
            let neighbours = &self.stamps[index.saturating_sub(1)..(index + 2).min(self.stamps.len())];
            neighbours.windows(2).all(|pair| pair[1].saturating_sub(pair[0]) as f64 <= NEAR * interval)
        };
        let found: Vec<usize> = spikes(&self.values).into_iter().filter(|&index| is_near(index)).collect();
        let left_out = found.iter().filter_map(|&index| self.get(index)).collect();
        remove(&mut self.values, &found);
        remove(&mut self.stamps, &found);
        left_out
    }

    /// First and last stamp, ns.
    pub fn range(&self) -> Option<(i64, i64)> {
        self.stamps.first().copied().zip(self.stamps.last().copied())
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.stamps.len()
    }

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.stamps.is_empty()
    }
}

/// Removes the values at these indices, which ascend.
fn remove<T>(values: &mut Vec<T>, indices: &[usize]) {
    let (mut index, mut next) = (0, indices.iter().peekable());
    values.retain(|_| {
        let is_kept = next.next_if(|removed| **removed == index).is_none();
        index += 1;
        is_kept
    });
}
