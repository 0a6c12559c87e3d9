//! The distribution of values, in bounded memory.

use hdrhistogram::Histogram;

/// This many values are stored exactly: four minutes at 1 kHz, 2 MB. Further values are counted in bins.
const KEPT: usize = 1 << 18;
/// Significant digits of a bin's distance from the first median: bins are 0.1 % of that distance wide, and at least 1
/// ns.
const DIGITS: u8 = 3;

/// Values in nanoseconds: exact up to [`KEPT`], then in bins around the median of the first [`KEPT`].
#[derive(Debug)]
pub(super) enum Spread {
    Exact(Vec<i64>),
    Binned { centre: i64, below: Histogram<u64>, from_centre: Histogram<u64> },
}

impl Default for Spread {
    fn default() -> Self {
        Spread::Exact(Vec::new())
    }
}

impl Spread {
    /// Adds one value.
    pub fn note(&mut self, value: i64) {
        match self {
            Spread::Exact(values) if values.len() < KEPT => values.push(value),
            Spread::Exact(_) => {
                self.begin_bins();
                self.note(value);
            }
            Spread::Binned { centre, below, from_centre } => {
                let side = if value < *centre { below } else { from_centre };
                let distance = value.abs_diff(*centre);
                // The histogram grows as needed; values beyond its range are clamped to its maximum.
                if side.record(distance).is_err() {
                    side.saturating_record(distance);
                }
            }
        }
    }

    fn begin_bins(&mut self) {
        let Spread::Exact(values) = std::mem::take(self) else { return };
        let centre = Bins::of_values(&values).quantile(0.5).unwrap_or_default();
        let (Ok(below), Ok(from_centre)) = (Histogram::new(DIGITS), Histogram::new(DIGITS)) else { return };
        *self = Spread::Binned { centre, below, from_centre };
        for value in values {
            self.note(value);
        }
    }

    /// The values with their counts, sorted.
    pub fn bins(&self) -> Bins {
        match self {
            Spread::Exact(values) => Bins::of_values(values),
            Spread::Binned { centre, below, from_centre } => {
                let of = |side: &Histogram<u64>| -> Vec<(i64, u64)> {
                    let bins = side.iter_recorded();
                    bins.map(|bin| {
                        let distance = side.median_equivalent(bin.value_iterated_to());
                        (i64::try_from(distance).unwrap_or(i64::MAX), bin.count_since_last_iteration())
                    })
                    .collect()
                };
                let below =
                    of(below).into_iter().rev().map(|(distance, count)| (centre.saturating_sub(distance), count));
                let above =
                    of(from_centre).into_iter().map(|(distance, count)| (centre.saturating_add(distance), count));
                Bins(below.chain(above).collect())
            }
        }
    }
}

/// Values with their counts, sorted by value.
#[derive(Debug)]
pub(super) struct Bins(Vec<(i64, u64)>);

impl Bins {
    fn of_values(values: &[i64]) -> Bins {
        let mut bins: Vec<(i64, u64)> = values.iter().map(|&value| (value, 1)).collect();
        bins.sort_unstable();
        Bins(bins)
    }

    /// The value that this share of the values does not exceed; `None` without values.
    pub fn quantile(&self, share: f64) -> Option<i64> {
        let last = self.count(|_| true).checked_sub(1)?;
        let place = (last as f64 * share) as u64;
        let mut passed = 0;
        let at = self.0.iter().find(|(_, count)| {
            passed += count;
            passed > place
        });
        at.map(|&(value, _)| value)
    }

    /// The distances of the values from `centre`.
    pub fn distances_from(&self, centre: i64) -> Bins {
        let mut distances: Vec<(i64, u64)> =
            self.0.iter().map(|&(value, count)| (value.saturating_sub(centre).saturating_abs(), count)).collect();
        distances.sort_unstable();
        Bins(distances)
    }

    /// The number of values that match.
    pub fn count(&self, such: impl Fn(i64) -> bool) -> u64 {
        self.0.iter().filter(|(value, _)| such(*value)).map(|(_, count)| count).sum()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// A clock of 1 ms with jitter up to 50 us and one pause of 1 s: binned quantiles must match the exact ones.
    #[test]
    fn bins_answer_as_the_values_would() {
        let mut spread = Spread::default();
        let count = 3 * KEPT as i64;
        let values: Vec<i64> =
            (0..count).map(|k| 1_000_000 + (k * 7_919) % 100_001 - 50_000).chain([1_000_000_000]).collect();
        values.iter().for_each(|&value| spread.note(value));
        assert!(matches!(spread, Spread::Binned { .. }));
        let (bins, exact) = (spread.bins(), Bins::of_values(&values));
        for share in [0.0, 0.05, 0.5, 0.95, 1.0] {
            let (found, expected) = (bins.quantile(share).unwrap(), exact.quantile(share).unwrap());
            let distance = (expected - 1_000_000).abs();
            assert!((found - expected).abs() <= 4 + distance / 500, "{share}: {found}, not {expected}");
        }
        assert_eq!(bins.count(|_| true), values.len() as u64);
        assert_eq!(bins.count(|value| value > 1_500_000), 1);
        let jitter = bins.distances_from(1_000_000).quantile(0.95).unwrap();
        assert!((jitter - 47_500).abs() < 100, "{jitter}");
    }

    #[test]
    fn extreme_values_are_taken() {
        let mut spread = Spread::default();
        (0..=KEPT).for_each(|k| spread.note(if k % 2 == 0 { i64::MIN } else { i64::MAX }));
        assert_eq!(spread.bins().count(|_| true), KEPT as u64 + 1);
        assert_eq!(Spread::default().bins().quantile(0.5), None);
    }
}
