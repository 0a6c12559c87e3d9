//! Result of `changed`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::change::{Changes, ParameterChange};

/// What differs between recordings before and recordings after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Change {
    /// Parameters that changed, the most significant first.
    pub changed: Vec<ChangedParameter>,
    /// Parameters that both sides determine and that did not change.
    pub unchanged: Vec<ChangedParameter>,
    /// Parameters that one side or both do not determine.
    pub undetermined: Vec<ChangedParameter>,
    /// Mean logarithm of the squared error over the variance of the noise, before and after, each with its own parameters; 0 where
    /// only noise is left.
    pub log_error_ratios: [Option<f64>; 2],
}

/// A parameter before and after.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ChangedParameter {
    /// Contract name, `arm.coulomb_friction`.
    pub name: String,
    /// SI unit; `-` for a pure number.
    pub unit: String,
    /// Value before, in `unit`.
    pub before: Option<f64>,
    /// Value after, in `unit`.
    pub after: Option<f64>,
    /// Half width of the 95 % interval before, in `unit`; `null` where it is not determined.
    pub before_margin_95: Option<f64>,
    /// Half width of the 95 % interval after, in `unit`; `null` where it is not determined.
    pub after_margin_95: Option<f64>,
    /// After less before, in `unit`.
    pub difference: Option<f64>,
    /// Half width of the 95 % interval of the difference, in `unit`.
    pub difference_margin_95: Option<f64>,
    /// The difference in standard errors.
    pub significance: Option<f64>,
}

impl Change {
    /// Of a comparison.
    pub fn of(changes: &Changes) -> Self {
        Change {
            changed: changes.changed().map(ChangedParameter::of).collect(),
            unchanged: changes.unchanged().map(ChangedParameter::of).collect(),
            undetermined: changes.undetermined().map(ChangedParameter::of).collect(),
            log_error_ratios: [&changes.before, &changes.after].map(|fit| finite(fit.loss())),
        }
    }
}

impl ChangedParameter {
    fn of(one: &ParameterChange) -> Self {
        ChangedParameter {
            name: one.name.clone(),
            unit: one.unit.clone(),
            before: finite(one.values[0]),
            after: finite(one.values[1]),
            before_margin_95: finite(one.margins_95[0]),
            after_margin_95: finite(one.margins_95[1]),
            difference: finite(one.difference()),
            difference_margin_95: finite(one.margin_95()),
            significance: finite(one.significance()),
        }
    }
}
