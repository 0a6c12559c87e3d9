//! What is left where nothing explains it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::diagnosis;

/// A residual that no known effect explains, as a curve over the variable that it follows most closely.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Unexplained {
    /// The equation with the largest residual: `arm.motion`.
    pub equation: String,
    /// The variable: `speed`, `command`, ...
    pub variable: String,
    /// Share of that equation's squared residual that a curve over the variable explains, 0 to 1.
    pub share_of_residual: Option<f64>,
    /// Whether that is enough to name the variable.
    #[serde(default)]
    pub follows_variable: bool,
    /// Whether one effect is most of what is missing, and what it leaves looks like another form of it.
    #[serde(default)]
    pub differs_in_form: bool,
    /// Unit of the residual: N m, N for a load without joint, or m3/s.
    pub unit: String,
    /// Points of the curve: the variable (SI unit), mean residual, its standard error (both in `unit`).
    pub curve: Vec<[Option<f64>; 3]>,
}

impl Unexplained {
    /// Of what a diagnosis could not explain.
    pub fn of(rest: &diagnosis::Unexplained) -> Self {
        Unexplained {
            equation: rest.equation.clone(),
            variable: rest.variable.to_string(),
            share_of_residual: finite(rest.share_of_residual),
            follows_variable: rest.follows_variable,
            differs_in_form: rest.differs_in_form,
            unit: rest.unit.to_string(),
            curve: rest.curve.iter().map(|point| point.map(finite)).collect(),
        }
    }
}
