//! What a model leaves in each balance.

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::residual_points::{Point, mean_squares};
use crate::nullable::Nullable;
use crate::regression::EquationKind;

/// What is left in one balance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "Balance")]
pub struct Remainder {
    /// Name of the equation: `arm.motion`.
    pub equation: String,
    /// Mean squared residual of the given model over the variance of its noise: 1 is noise alone.
    #[serde(with = "Nullable")]
    pub before: f64,
    /// The same with the effects that the verdict supports.
    #[serde(with = "Nullable")]
    pub after: f64,
    /// Whether noise is all that is left with them.
    pub is_noise: bool,
}

/// The remainder in each balance, the largest first. `given` and `supported` are residuals of both models. Up to `most` times the
/// variance of the noise, a remainder is noise.
pub(super) fn remainders(model: &Model, given: &[Point], supported: &[Point], most: f64) -> Vec<Remainder> {
    let (before, after) = (mean_squares(given), mean_squares(supported));
    let of = |(kind, after): (EquationKind, f64)| {
        let (_, before) = before.iter().copied().find(|(own, _)| *own == kind)?;
        Some(Remainder { equation: kind.name(model), before, after, is_noise: after <= most })
    };
    let mut all: Vec<Remainder> = after.into_iter().filter_map(of).collect();
    all.sort_by(|a, b| b.after.total_cmp(&a.after));
    all
}
