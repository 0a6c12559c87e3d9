//! Reduces the points of a plot and keeps its extremes.

use excavator_model::recording::median_interval;

/// Length of a gap, in sampling intervals, from which a line is interrupted.
const TORN: f64 = 10.0;

/// Indices of at most about `budget` samples that keep the extremes of every series. The time axis is cut into equal
/// runs, and in each run the samples with the smallest and largest value of a series are kept.
pub(super) fn indices(series: &[&[f64]], samples: usize, budget: usize) -> Vec<usize> {
    if samples <= budget || series.is_empty() {
        return (0..samples).collect();
    }
    let runs = (budget / (2 * series.len())).max(1);
    let mut kept = Vec::with_capacity(budget);
    for run in 0..runs {
        let (start, end) = (run * samples / runs, (run + 1) * samples / runs);
        let first = kept.len();
        for values in series {
            let finite = || (start..end).filter(|&index| values.get(index).is_some_and(|value| value.is_finite()));
            kept.extend(finite().min_by(|&a, &b| values[a].total_cmp(&values[b])));
            kept.extend(finite().max_by(|&a, &b| values[a].total_cmp(&values[b])));
        }
        // A run with a sample that was not measured must stay visible as a gap.
        for values in series {
            kept.extend((start..end).find(|&index| values.get(index).is_some_and(|value| !value.is_finite())));
        }
        kept[first..].sort_unstable();
    }
    kept.dedup();
    kept
}

/// Positions in `kept` before a time gap, where a line must end.
pub(super) fn gaps(time: &[f64], kept: &[usize]) -> Vec<usize> {
    let longest = TORN * median_interval(time);
    let mut before = Vec::with_capacity(time.len());
    let mut count = 0_usize;
    for index in 0..time.len() {
        count += usize::from(index > 0 && time[index] - time[index - 1] > longest);
        before.push(count);
    }
    let at = |index: usize| before.get(index).copied().unwrap_or(count);
    let pairs = kept.windows(2).enumerate().filter(|(_, pair)| at(pair[1]) > at(pair[0]));
    pairs.map(|(place, _)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_of_the_clock_is_found_between_kept_samples() {
        let time: Vec<f64> = (0..100).map(|k| 0.01 * k as f64 + if k >= 50 { 3.0 } else { 0.0 }).collect();
        assert_eq!(gaps(&time, &[0, 30, 49, 50, 99]), vec![2]);
        assert_eq!(gaps(&time, &[0, 40, 70, 99]), vec![1]);
        assert!(gaps(&time[..50], &[0, 20, 49]).is_empty());
    }

    #[test]
    fn extremes_and_gaps_survive() {
        let mut values = vec![0.0; 10_000];
        values[4321] = 5.0;
        values[4322] = -5.0;
        values[7777] = f64::NAN;
        let other: Vec<f64> = (0..10_000).map(|index| index as f64).collect();
        let kept = indices(&[&values, &other], 10_000, 2000);
        assert!(kept.len() <= 2010, "{}", kept.len());
        assert!(kept.contains(&4321) && kept.contains(&4322) && kept.contains(&7777));
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(indices(&[&values], 10, 2000).len(), 10);
    }
}
