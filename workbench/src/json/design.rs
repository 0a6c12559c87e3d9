//! Designs of manoeuvres.

use std::path::Path;

use excavator_identification::design::{ParameterDesign, Plan, SeparationDesign};
use excavator_model::Model;
use serde_json::{Value, json};

use super::finite;

fn plan_json(plan: &Plan, manoeuvres: (usize, usize)) -> Value {
    let chosen: Vec<Value> =
        plan.chosen.iter().map(|(name, start)| json!({"name": name, "start": finite(*start)})).collect();
    json!({
        "duration": finite(plan.duration),
        "manoeuvres": chosen,
        "library": manoeuvres.0,
        "within_limits": manoeuvres.1,
    })
}

fn unknowns(model: &Model) -> Vec<Value> {
    let names = model.parameter_names();
    let all: Vec<_> = model.parameters().map(|(_, parameter)| parameter).collect();
    model
        .unknown_parameters()
        .into_iter()
        .map(|index| json!({"name": names[index], "value": finite(all[index].value), "unit": all[index].card.unit}))
        .collect()
}

/// Result of `design` for rivals; `profile` is the file written, if one was.
pub fn separation_json(design: &SeparationDesign, profile: Option<&Path>) -> Value {
    let rivals: Vec<Value> =
        design.rivals.iter().map(|rival| json!({"name": rival.name, "parameters": unknowns(&rival.model)})).collect();
    let pairs: Vec<Value> = design
        .pairs
        .iter()
        .map(|pair| {
            json!({
                "first": pair.first,
                "second": pair.second,
                "improvement_on_sines": pair.improvement_before.map_or(Value::Null, finite),
                "distance": finite(pair.distance),
                "linear_improvement": finite(pair.linear_improvement),
                "expected_improvement": finite(pair.expected_improvement),
                "expected_significance": finite(pair.expected_significance),
                "separated": pair.separated,
            })
        })
        .collect();
    let trial_runs: Vec<Value> = design
        .trial_runs
        .iter()
        .map(|one| {
            json!({
                "truth": one.truth,
                "other": one.other,
                "improvement": finite(one.improvement),
                "significance": finite(one.significance),
            })
        })
        .collect();
    json!({
        "profile": profile.map(|path| path.display().to_string()),
        "all_separated": design.all_separated(),
        "rivals": rivals,
        "pairs": pairs,
        "trial_runs": trial_runs,
        "plan": plan_json(&design.plan, design.manoeuvres),
    })
}

/// Result of `design` for a parameter; `profile` is the file written, if one was.
pub fn determination_json(design: &ParameterDesign, profile: Option<&Path>) -> Value {
    json!({
        "profile": profile.map(|path| path.display().to_string()),
        "parameter": design.name,
        "unit": design.unit,
        "value": finite(design.value),
        "std_error_given": design.given_error.map_or(Value::Null, finite),
        "std_error_on_sines": finite(design.sine_error),
        "std_error_expected": finite(design.expected_error),
        "std_error_trial_run": finite(design.trial_run_error),
        "value_trial_run": finite(design.trial_run_value),
        "determined": design.determined,
        "plan": plan_json(&design.plan, design.manoeuvres),
    })
}
