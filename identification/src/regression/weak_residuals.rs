//! Residuals of the weak form along a recording.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::equation::EquationKind;
use super::seen::Seen;
use super::weak_rows::rows;
use super::{RegressionError, WeakFormSettings};

/// Residual of one equation in one window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WeakResidual {
    /// Which equation.
    pub kind: EquationKind,
    /// Sample in the middle of the window.
    pub sample: usize,
    /// Residual in units of its standard deviation from sensor noise.
    pub in_noise_units: f64,
    /// Mean residual over the window, N m (N) or m³/s.
    pub mean: f64,
}

/// Residuals of all equations of `model` along a recording at the present parameters.
///
/// # Errors
/// [`RegressionError`] if the recording lacks inputs.
pub fn weak_residuals(
    model: &Model,
    recording: &Recording,
    settings: &WeakFormSettings,
) -> Result<Vec<WeakResidual>, RegressionError> {
    let seen = [Seen::of(model, recording, None)?];
    let rows = rows(model, &[recording], settings, &[], false, &seen)?;
    let (half_width, _) = settings.widths(model, &[recording]);
    // Integral of the test function (1 - x²)^4 over [-1, 1].
    const BUMP_AREA: f64 = 256.0 / 315.0;
    let residuals = rows.iter().map(|row| WeakResidual {
        kind: row.kind,
        sample: recording.time.partition_point(|&t| t < row.centre).min(recording.len() - 1),
        in_noise_units: row.residual,
        mean: row.residual * row.noise / (BUMP_AREA * half_width),
    });
    Ok(residuals.collect())
}
