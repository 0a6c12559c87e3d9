//! Friction against speed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Estimate, finite};
use crate::characterisation;

/// Friction against speed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Friction {
    /// Whether a load cell measured the load; otherwise it is the model's, times a fitted share.
    pub from_load_cell: bool,
    /// Load over the model's load; `null` where a load cell measured it.
    pub load_share: Option<Estimate>,
    /// Terms of the curve: Coulomb, viscous, and what else shows.
    pub terms: Vec<FrictionTerm>,
    /// Speed at which Stribeck friction has fallen to 37 %, m/s; `null` where it does not show.
    pub stribeck_speed: Option<Estimate>,
    /// Root mean square distance of the points from the curve, N.
    pub scatter: Option<f64>,
    /// Why these terms.
    pub reason: String,
    /// Steady stretches in order of speed: piston speed (m/s) and friction (N).
    pub speed_and_force: Vec<[Option<f64>; 2]>,
}

/// A term of the friction curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct FrictionTerm {
    /// Effect of the catalogue that has it.
    pub effect: String,
    /// What the coefficient is multiplied by, as a formula of the speed.
    pub times: String,
    /// Coefficient, in `unit`.
    pub value: Option<f64>,
    /// Standard error of the coefficient, in `unit`.
    pub std_error: Option<f64>,
    /// SI unit of the coefficient.
    pub unit: String,
}

impl Friction {
    pub(super) fn of(curve: &characterisation::FrictionCurve) -> Self {
        Friction {
            from_load_cell: curve.from_load_cell,
            load_share: curve.load_share.map(Estimate::of),
            terms: curve.terms.iter().map(FrictionTerm::of).collect(),
            stribeck_speed: curve.stribeck_speed.map(Estimate::of),
            scatter: finite(curve.scatter),
            reason: curve.reason.clone(),
            speed_and_force: curve.points.iter().map(|point| [finite(point.speed), finite(point.force)]).collect(),
        }
    }
}

impl FrictionTerm {
    fn of(term: &characterisation::FrictionTerm) -> Self {
        FrictionTerm {
            effect: term.effect.to_string(),
            times: term.shape.to_string(),
            value: finite(term.coefficient.value),
            std_error: finite(term.coefficient.error),
            unit: term.unit.to_string(),
        }
    }
}
