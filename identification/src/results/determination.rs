//! Result of `design` for a parameter.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Plan, finite};
use crate::design;

/// A profile that shows a parameter, and what to expect of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Determination {
    /// The profile file that was written; `null` where the parameter would stay open.
    pub profile: Option<String>,
    /// Contract name of the parameter.
    pub parameter: String,
    /// SI unit of the parameter; `-` for a pure number.
    pub unit: String,
    /// Its value in the model, in `unit`.
    pub value: Option<f64>,
    /// Its standard error in the model, in `unit`; `null` where it was not identified before.
    pub std_error_given: Option<f64>,
    /// Standard error from moderate sines of the profile's length, from sensor noise alone, in `unit`.
    pub std_error_on_sines: Option<f64>,
    /// Standard error from the profile, from sensor noise alone, in `unit`.
    pub std_error_expected: Option<f64>,
    /// Standard error that a fit reports of a trial run with noisy sensors, in `unit`.
    pub std_error_trial_run: Option<f64>,
    /// Value that this fit finds, in `unit`.
    pub value_trial_run: Option<f64>,
    /// Whether the standard error is expected to be below half of the value.
    pub determined: bool,
    /// What is to be done.
    pub plan: Plan,
}

impl Determination {
    /// Of a design; `profile` is the file that was written, if one was.
    pub fn of(design: &design::ParameterDesign, profile: Option<&str>) -> Self {
        Determination {
            profile: profile.map(str::to_string),
            parameter: design.name.clone(),
            unit: design.unit.to_string(),
            value: finite(design.value),
            std_error_given: design.given_error.and_then(finite),
            std_error_on_sines: finite(design.sine_error),
            std_error_expected: finite(design.expected_error),
            std_error_trial_run: finite(design.trial_run_error),
            value_trial_run: finite(design.trial_run_value),
            determined: design.determined,
            plan: Plan::of(&design.plan, design.manoeuvres),
        }
    }
}
