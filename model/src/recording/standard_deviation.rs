//! Standard deviation of a signal.

/// Standard deviation of the finite values of a signal; 0 if there are none.
pub fn standard_deviation(signal: &[f64]) -> f64 {
    let finite = || signal.iter().filter(|value| value.is_finite());
    let count = finite().count() as f64;
    if count == 0.0 {
        return 0.0;
    }
    let mean = finite().sum::<f64>() / count;
    (finite().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}
