//! What a model leaves in each balance.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::residual_points::points;
use crate::regression::{EquationKind, RegressionError};

/// What is left in one balance.
#[derive(Debug, Clone, PartialEq)]
pub struct Remainder {
    /// `arm.motion`, `arm.cap_continuity`, ...
    pub equation: String,
    /// Mean squared residual of the given model over the variance of its noise.
    pub before: f64,
    /// The same of the model with the effects that the verdict supports.
    pub after: f64,
    /// Whether noise is all that is left with these effects.
    pub is_noise: bool,
}

/// Mean squared residual, over the variance of the noise, up to which a remainder is noise. Right models leave 0.3 to 1.3 at 500 Hz.
const NOISE: f64 = 2.0;

/// The remainder in each balance, the largest first. Where `explains`, simulations with the supported model leave noise only. Slow
/// recordings do not resolve a second derivative, so the force balance may seem to leave more; that is no evidence then.
///
/// # Errors
/// [`RegressionError`] if the recordings lack inputs.
pub(super) fn remainders(
    given: &Model,
    supported: &Model,
    recordings: &[&Recording],
    explains: bool,
) -> Result<Vec<Remainder>, RegressionError> {
    let (before, after) = (mean_squares(given, recordings)?, mean_squares(supported, recordings)?);
    let of = |(kind, after): (EquationKind, f64)| {
        let (_, before) = before.iter().copied().find(|(own, _)| *own == kind)?;
        Some(Remainder { equation: kind.name(given), before, after, is_noise: explains || after <= NOISE })
    };
    let mut all: Vec<Remainder> = after.into_iter().filter_map(of).collect();
    all.sort_by(|a, b| b.after.total_cmp(&a.after));
    Ok(all)
}

fn mean_squares(model: &Model, recordings: &[&Recording]) -> Result<Vec<(EquationKind, f64)>, RegressionError> {
    let mut sums: Vec<(EquationKind, f64, f64)> = Vec::new();
    for point in points(model, recordings)? {
        let square = point.weighed * point.weighed;
        match sums.iter_mut().find(|(kind, ..)| *kind == point.kind) {
            Some((_, sum, count)) => {
                *sum += square;
                *count += 1.0;
            }
            None => sums.push((point.kind, square, 1.0)),
        }
    }
    Ok(sums.into_iter().map(|(kind, sum, count)| (kind, sum / count)).collect())
}
