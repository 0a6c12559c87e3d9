//! Result of `design` for tied effects.

use excavator_model::Model;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{GivenValue, Plan, finite};
use crate::design;

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

/// What is expected of two rivals under the profile; of both directions, in which either is the truth, the worse one counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct PairSeparation {
    /// Name of one rival.
    pub first: String,
    /// Name of the other.
    pub second: String,
    /// Difference of their losses on moderate sines that both were fitted to; `null` where rivals came with fitted values.
    pub improvement_on_sines: Option<f64>,
    /// Distance in standard deviations of sensor noise, after a linearised refit.
    pub distance: Option<f64>,
    /// Fall of the log error ratio that goes with the distance, without noise on the spools.
    pub linear_improvement: Option<f64>,
    /// Fall of the log error ratio from the other to the truth in the trial run.
    pub expected_improvement: Option<f64>,
    /// The same in its own standard errors.
    pub expected_significance: Option<f64>,
    /// Whether a diagnosis would no longer call them tied.
    pub separated: bool,
}

/// One rival as the truth, and another one held against it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct TrialRun {
    /// Name of the rival that made the recordings.
    pub truth: String,
    /// Name of the rival that was fitted to them.
    pub other: String,
    /// By how much less the log error ratio of the truth is on the recording that was not fitted.
    pub improvement: Option<f64>,
    /// The same in its own standard errors.
    pub significance: Option<f64>,
}

impl Separation {
    /// Of a design; `profile` is the file that was written, if one was.
    pub fn of(design: &design::SeparationDesign, profile: Option<&str>) -> Self {
        let rivals = design.rivals.iter();
        Separation {
            profile: profile.map(str::to_string),
            all_separated: design.all_separated(),
            rivals: rivals.map(|one| Rival { name: one.name.clone(), parameters: unknowns(&one.model) }).collect(),
            pairs: design.pairs.iter().map(PairSeparation::of).collect(),
            trial_runs: design.trial_runs.iter().map(TrialRun::of).collect(),
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

impl PairSeparation {
    fn of(pair: &design::PairSeparation) -> Self {
        PairSeparation {
            first: pair.first.clone(),
            second: pair.second.clone(),
            improvement_on_sines: pair.improvement_before.and_then(finite),
            distance: finite(pair.distance),
            linear_improvement: finite(pair.linear_improvement),
            expected_improvement: finite(pair.expected_improvement),
            expected_significance: finite(pair.expected_significance),
            separated: pair.separated,
        }
    }
}

impl TrialRun {
    fn of(run: &design::TrialRun) -> Self {
        TrialRun {
            truth: run.truth.clone(),
            other: run.other.clone(),
            improvement: finite(run.improvement),
            significance: finite(run.significance),
        }
    }
}
