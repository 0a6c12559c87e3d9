//! Measures of fit (\[A\] Section 4.2, \[B\] Table I).

/// Normalised mean squared error `sum (y - yhat)² / sum (y - mean y)²` over samples where both are finite. Returns
/// `NaN` if nothing can be compared or the measurement never changes.
pub fn normalised_mean_squared_error(measured: &[f64], simulated: &[f64]) -> f64 {
    let pairs = || measured.iter().zip(simulated).filter(|(m, s)| m.is_finite() && s.is_finite());
    let count = pairs().count() as f64;
    let mean = pairs().map(|(m, _)| m).sum::<f64>() / count;
    let spread: f64 = pairs().map(|(m, _)| (m - mean).powi(2)).sum();
    if spread > 0.0 { pairs().map(|(m, s)| (m - s).powi(2)).sum::<f64>() / spread } else { f64::NAN }
}

/// Root of the mean squared difference of the samples that both signals have, in their unit; `NaN` if there is none.
pub fn root_mean_squared_error(measured: &[f64], simulated: &[f64]) -> f64 {
    let squares = || measured.iter().zip(simulated).map(|(m, s)| (m - s).powi(2)).filter(|square| square.is_finite());
    (squares().sum::<f64>() / squares().count() as f64).sqrt()
}

/// `FIT = 100 (1 - ||y - yhat|| / ||y - mean y||)` in %, from the normalised mean squared error.
pub fn fit_percent(normalised_error: f64) -> f64 {
    100.0 * (1.0 - normalised_error.sqrt())
}
