//! Result of `refine`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::SignalComparison;
use crate::decision::Kind;
use crate::validation::Comparison;

/// A refined model: what was added at each step, and how the model then compares with the validation recordings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Refinement {
    /// The verdict on the given model; for named additions, whether they explain what it was missing.
    pub verdict: Kind,
    /// The steps; the first is before anything is added.
    pub steps: Vec<RefinementStep>,
    /// The model file that was written; `null` where none was.
    pub model: Option<String>,
}

/// The model after one addition.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct RefinementStep {
    /// What was added, `effect@place`; `null` for the given model, refitted.
    pub added: Option<String>,
    /// The signals by contract name, over all validation recordings.
    pub signals: BTreeMap<String, SignalComparison>,
}

impl Refinement {
    /// Of steps, each with what it added and its comparisons with the validation recordings, and the model file, if one was written.
    pub fn of<'s>(
        verdict: Kind,
        steps: impl IntoIterator<Item = (Option<&'s str>, &'s [Comparison])>,
        model: Option<&str>,
    ) -> Self {
        let steps = steps.into_iter().map(|(added, comparisons)| RefinementStep {
            added: added.map(str::to_string),
            signals: SignalComparison::all(comparisons),
        });
        Refinement { verdict, steps: steps.collect(), model: model.map(str::to_string) }
    }
}
