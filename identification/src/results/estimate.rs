//! An estimate, or why there is none.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::characterisation::{self, Refusal};

/// What was found, or why it was not.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum Outcome<T> {
    /// Not found.
    Refused(Refused),
    /// Found.
    Found(T),
}

/// Why something was not found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Refused {
    /// Which signal or manoeuvre is missing, with numbers.
    pub refused: String,
}

/// An estimate, in the unit of the quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Estimate {
    /// Value.
    pub value: Option<f64>,
    /// Standard error of the value.
    pub std_error: Option<f64>,
}

impl<R> Outcome<R> {
    pub(super) fn of<T>(found: &Result<T, Refusal>, of: impl Fn(&T) -> R) -> Self {
        match found {
            Ok(found) => Outcome::Found(of(found)),
            Err(refusal) => Outcome::Refused(Refused { refused: refusal.to_string() }),
        }
    }
}

impl Estimate {
    pub(super) fn of(estimate: characterisation::Estimate) -> Self {
        Estimate { value: finite(estimate.value), std_error: finite(estimate.error) }
    }
}
