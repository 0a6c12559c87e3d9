//! What a single term promises.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GivenValue, finite};
use crate::proposal;

/// The law of one term that promises most. It was not fitted, and not judged.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Guess {
    /// The formula.
    pub formula: String,
    /// The row of the equations that it enters: `piston_force`. `excavator effects --language` lists them with their units.
    pub acts_on: String,
    /// Name of its place: a cylinder, `pump` or `machine`.
    pub at: String,
    /// Its parameters, after a first step.
    pub parameters: Vec<GivenValue>,
    /// Fall of the loss of the identification recordings that it promises.
    pub promised_improvement: Option<f64>,
}

impl Guess {
    /// Of a guess.
    pub fn of(guess: &proposal::Guess) -> Self {
        let parameters = guess.text.parameters.iter().map(|(name, parameter)| GivenValue {
            name: name.clone(),
            value: parameter.start.first().copied().and_then(finite),
            unit: parameter.unit.clone(),
        });
        Guess {
            formula: guess.text.formula.clone(),
            acts_on: guess.text.acts_on.clone(),
            at: guess.place.clone(),
            parameters: parameters.collect(),
            promised_improvement: finite(guess.improvement),
        }
    }
}
