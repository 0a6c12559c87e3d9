//! What a model leaves in each balance.

use excavator_model::Model;

use super::residual_points::{Point, mean_squares};
use crate::regression::EquationKind;

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

/// The remainder in each balance, the largest first. Where `explains`, simulations with the supported model leave noise only. `given` and `supported` are residuals of both models. Slow
/// recordings do not resolve a second derivative, so the force balance may seem to leave more; that is no evidence then.
pub(super) fn remainders(model: &Model, given: &[Point], supported: &[Point], explains: bool) -> Vec<Remainder> {
    let (before, after) = (mean_squares(given), mean_squares(supported));
    let of = |(kind, after): (EquationKind, f64)| {
        let (_, before) = before.iter().copied().find(|(own, _)| *own == kind)?;
        Some(Remainder { equation: kind.name(model), before, after, is_noise: explains || after <= NOISE })
    };
    let mut all: Vec<Remainder> = after.into_iter().filter_map(of).collect();
    all.sort_by(|a, b| b.after.total_cmp(&a.after));
    all
}
