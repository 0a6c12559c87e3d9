//! Errors relative to the variance of the signals.

use excavator_model::recording::{Recording, standard_deviation};

use super::Fit;

/// Mean over instruments of squared error over the signal's own variance. Returns `NaN` if no signal varies.
pub fn normalised_error(fit: &Fit, recordings: &[&Recording]) -> f64 {
    let errors: Vec<f64> = fit
        .instruments
        .iter()
        .zip(&fit.errors)
        .filter_map(|(instrument, error)| {
            let signals = recordings.iter().filter_map(|recording| recording.signal(&instrument.name));
            let spread = signals.map(standard_deviation).fold(0.0, f64::max);
            (spread > 0.0).then(|| (error / spread).powi(2))
        })
        .collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}
