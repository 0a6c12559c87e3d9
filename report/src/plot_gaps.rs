//! Gaps of a plot whose points are reduced.

use excavator_model::recording::median_interval;

/// Length of a gap, in sampling intervals, from which a line is interrupted.
const TORN: f64 = 10.0;

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
}
