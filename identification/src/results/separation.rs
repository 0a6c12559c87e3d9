//! Result of `design` for tied effects.

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GivenValue, Plan, finite};
use crate::design::{self, PairSeparation, TrialRun};

/// A profile that separates rivals, and what to expect of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct Separation {
    /// The profile file that was written; `null` where no pair is separated.
    pub profile: Option<String>,
    /// Whether every pair is expected to be separated.
    pub all_separated: bool,
    /// The rivals.
    pub rivals: Vec<Rival>,
    /// What is expected of every pair.
    pub pairs: Vec<PairSeparation>,
    /// Trial runs, each rival once as the truth.
    pub trial_runs: Vec<TrialRun>,
    /// What is to be done.
    pub plan: Plan,
}

/// One explanation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Rival {
    /// `EFFECT@PLACE`, or `none` for the model as it is.
    pub name: String,
    /// Its unknown parameters with the values that it was compared with.
    pub parameters: Vec<GivenValue>,
}

impl Separation {
    /// Of a design; `profile` is the file that was written, if one was.
    pub fn of(design: &design::SeparationDesign, profile: Option<&str>) -> Self {
        let rivals = design.rivals.iter();
        Separation {
            profile: profile.map(str::to_string),
            all_separated: design.all_separated(),
            rivals: rivals.map(|one| Rival { name: one.name.clone(), parameters: unknowns(&one.model) }).collect(),
            pairs: design.pairs.clone(),
            trial_runs: design.trial_runs.clone(),
            plan: Plan::of(&design.plan, design.manoeuvres),
        }
    }
}

fn unknowns(model: &Model) -> Vec<GivenValue> {
    let names = model.parameter_names();
    let all: Vec<_> = model.parameters().map(|(_, parameter)| parameter).collect();
    let unknown = model.unknown_parameters().into_iter();
    unknown
        .map(|index| GivenValue {
            name: names[index].clone(),
            value: finite(all[index].value),
            unit: all[index].card.unit.to_string(),
        })
        .collect()
}
