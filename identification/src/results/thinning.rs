//! Reduces samples and keeps the extremes of several series.

/// Indices of at most about `budget` samples that keep the extremes of every series. The time axis is cut into equal
/// runs, and in each run the samples with the smallest and largest value of a series are kept.
pub fn thinned(series: &[&[f64]], samples: usize, budget: usize) -> Vec<usize> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extremes_and_gaps_survive() {
        let mut values = vec![0.0; 10_000];
        values[4321] = 5.0;
        values[4322] = -5.0;
        values[7777] = f64::NAN;
        let other: Vec<f64> = (0..10_000).map(|index| index as f64).collect();
        let kept = thinned(&[&values, &other], 10_000, 2000);
        assert!(kept.len() <= 2010, "{}", kept.len());
        assert!(kept.contains(&4321) && kept.contains(&4322) && kept.contains(&7777));
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(thinned(&[&values], 10, 2000).len(), 10);
    }
}
