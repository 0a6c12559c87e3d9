//! A parameter without an uncertainty.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A parameter whose value no fit has judged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct GivenValue {
    /// Contract name, `arm.inertia`; of a guessed law its name in the formula.
    pub name: String,
    /// Value, in `unit`.
    pub value: Option<f64>,
    /// SI unit; `-` for a pure number.
    pub unit: String,
}
