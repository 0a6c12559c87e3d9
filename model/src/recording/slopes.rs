//! The rate of a sampled signal.

/// The slope of the straight line through the samples around each sample, per s: those within `half_width` s, and at least
/// `fewest` on each side. Samples that are not measured are skipped; `NaN` if fewer than two are left.
pub fn slopes(time: &[f64], values: &[f64], (half_width, fewest): (f64, usize)) -> Vec<f64> {
    let slope = |sample: usize| {
        let first = time.partition_point(|&t| t < time[sample] - half_width).min(sample.saturating_sub(fewest));
        let last = time.partition_point(|&t| t <= time[sample] + half_width).max(sample + fewest + 1);
        let range = first..last.min(time.len());
        let points = || {
            let samples = time[range.clone()].iter().zip(&values[range.clone()]);
            samples.filter(|(_, value)| value.is_finite())
        };
        let count = points().count() as f64;
        let mean = |value: fn((&f64, &f64)) -> f64| points().map(value).sum::<f64>() / count;
        let (middle, level) = (mean(|(t, _)| *t), mean(|(_, value)| *value));
        let spread: f64 = points().map(|(t, _)| (t - middle).powi(2)).sum();
        points().map(|(t, value)| (t - middle) * (value - level)).sum::<f64>() / spread
    };
    (0..time.len()).map(slope).collect()
}

#[cfg(test)]
mod tests {
    use super::slopes;

    #[test]
    fn a_line_has_its_slope_everywhere_and_one_sample_has_none() {
        let time: Vec<f64> = (0..50).map(|index| 0.01 * f64::from(index) + 0.001 * f64::from(index % 3)).collect();
        let mut values: Vec<f64> = time.iter().map(|t| 3.0 - 2.0 * t).collect();
        values[20] = f64::NAN;
        assert!(slopes(&time, &values, (0.0, 2)).iter().all(|slope| (slope + 2.0).abs() < 1e-9));
        assert!(slopes(&[0.0], &[1.0], (0.0, 2))[0].is_nan());
        assert!(slopes(&[], &[], (0.0, 2)).is_empty());
    }
}
