//! The values of one signal, each with its time.

/// Values sorted by stamp, without duplicate stamps.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Track {
    /// ns since the epoch, ascending.
    stamps: Vec<i64>,
    values: Vec<f64>,
}

impl Track {
    /// Sorts the values; of those with equal stamps the last one is used, as for commands.
    pub fn new(mut samples: Vec<(i64, f64)>) -> Track {
        samples.sort_by_key(|&(stamp, _)| stamp);
        let mut track = Track::default();
        for (stamp, value) in samples {
            match track.values.last_mut() {
                Some(last) if track.stamps.last() == Some(&stamp) => *last = value,
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

    /// Number of values.
    pub fn len(&self) -> usize {
        self.stamps.len()
    }

    /// Whether there is no value.
    pub fn is_empty(&self) -> bool {
        self.stamps.is_empty()
    }
}
