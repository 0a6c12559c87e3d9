//! Results for programs.

use std::path::Path;

use excavator_identification::diagnosis::{Adequacy, Candidate, Diagnosis, normalised_error};
use excavator_identification::fitted_along::found_along;
use excavator_identification::refinement::Refinement;
use excavator_identification::regression::ConditionNumber;
use excavator_identification::validation::{Comparison, Correlation};
use excavator_model::effects::Site;
use excavator_model::recording::Recording;
use excavator_model::{Model, site_name};
use serde_json::{Map, Value, json};

use crate::cli::Overwriting;
use crate::error::VerbError;

/// Writes JSON to a file, or to standard output for "-".
pub fn write_json(path: &Path, value: &Value, overwriting: Overwriting) -> Result<(), VerbError> {
    crate::outputs::write(path, &(serde_json::to_string_pretty(value)? + "\n"), overwriting)
}

/// JSON has no NaN: what is not a number is null.
pub(super) fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}

fn parameters(model: &Model, fitted: &[usize]) -> Vec<Value> {
    let names = model.parameter_names();
    model
        .parameters()
        .enumerate()
        .filter(|(index, _)| fitted.contains(index))
        .map(|(index, (_, parameter))| {
            json!({
                "name": names[index],
                "value": finite(parameter.value),
                "std_error": parameter.standard_error.map_or(Value::Null, finite),
                "margin_95": parameter.margin_95.map_or(Value::Null, finite),
                "unit": parameter.card.unit,
            })
        })
        .collect()
}

/// Result of `identify`.
pub fn identification_json(
    model: &Model,
    fitted: &[usize],
    conditions: &[ConditionNumber],
    rows: usize,
    equations: Vec<Value>,
    not_identified: &[(usize, String)],
) -> Value {
    let names = model.parameter_names();
    let conditions: Map<String, Value> = conditions
        .iter()
        .map(|c| (c.group.to_string(), json!({"unscaled": finite(c.unscaled), "scaled": finite(c.scaled)})))
        .collect();
    let not_identified: Vec<Value> =
        not_identified.iter().map(|(index, reason)| json!({"name": names[*index], "reason": reason})).collect();
    json!({
        "parameters": parameters(model, fitted),
        "condition_numbers": conditions,
        "rows": rows,
        "equations": equations,
        "not_identified": not_identified,
    })
}

fn signals(comparisons: &[Comparison]) -> Value {
    let Some(first) = comparisons.first() else { return json!({}) };
    let count = comparisons.len() as f64;
    let entries = first.signals.iter().enumerate().map(|(index, signal)| {
        let own = || comparisons.iter().filter_map(move |comparison| comparison.signals.get(index));
        let nmse = own().map(|s| s.normalised_error).sum::<f64>() / count;
        let fit = own().map(|s| s.fit).sum::<f64>() / count;
        let delays: Vec<f64> = own().filter_map(|s| s.phase_delay_degrees).collect();
        let delay = delays.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs())).map_or(Value::Null, finite);
        // Of several recordings the one that is furthest beyond its bound.
        let worst = |found: Vec<Correlation>| {
            let beyond = |one: &Correlation| one.value.abs() / one.bound;
            found.into_iter().max_by(|a, b| beyond(a).total_cmp(&beyond(b))).map_or(Value::Null, correlation)
        };
        let value = json!({
            "nmse": finite(nmse),
            "fit": finite(fit),
            "phase_delay_deg": delay,
            "autocorrelation": worst(own().filter_map(|s| s.autocorrelation).collect()),
            "input_correlation": worst(own().filter_map(|s| s.input_correlation).collect()),
        });
        (signal.name.clone(), value)
    });
    Value::Object(entries.collect())
}

fn correlation(found: Correlation) -> Value {
    json!({"value": finite(found.value), "lag_s": finite(found.lag), "bound": finite(found.bound)})
}

/// Result of `compare`.
pub fn comparison_json(comparison: &Comparison) -> Value {
    json!({
        "signals": signals(std::slice::from_ref(comparison)),
        "excitation_frequency_hz": comparison.excitation_frequency,
    })
}

/// Parameters that a model has of an effect at a site.
fn own_parameters(model: &Model, name: &str, site: Site) -> Vec<Value> {
    let is_own = |effect: usize| model.effects[effect].is(name, site);
    let indices: Vec<usize> =
        model.parameters().enumerate().filter(|(_, (effect, _))| is_own(*effect)).map(|(index, _)| index).collect();
    parameters(model, &indices)
}

/// One candidate. `found` is the model with all effects that were found: where the candidate is among them its parameters are
/// those beside the others, which one alone had to stand in for.
fn candidate_json(candidate: &Candidate, before: f64, validation: &[&Recording], found: Option<&Model>) -> Value {
    let alone = &candidate.fit.model;
    let model = found.filter(|model| model.has(candidate.name(), candidate.site)).unwrap_or(alone);
    json!({
        "effect": candidate.name(),
        "cylinder": candidate.place,
        "validation_error_before": finite(before),
        "validation_error_after": finite(normalised_error(&candidate.validation, validation)),
        "evidence": finite(candidate.evidence.gain),
        "significance": finite(candidate.evidence.significance),
        "bootstrap": {"gains": finite(candidate.inclusion.gains), "is_first": finite(candidate.inclusion.is_first)},
        "tied_with_first": candidate.tied_with_first,
        "parameters": own_parameters(model, candidate.name(), candidate.site),
        "refitted": parameters(model, &model.unknown_parameters()),
    })
}

/// What was fitted along in `fitted`, a model that began as `given`.
fn along_json(given: &Model, fitted: &Model) -> Vec<Value> {
    found_along(given, fitted)
        .map(|effect| {
            json!({
                "effect": effect.name(),
                "cylinder": site_name(&fitted.machine, effect.site),
                "parameters": own_parameters(fitted, effect.name(), effect.site),
            })
        })
        .collect()
}

/// Result of `diagnose` for the model `given`.
pub fn diagnosis_json(given: &Model, diagnosis: &Diagnosis, validation: &[&Recording]) -> Value {
    let before = normalised_error(&diagnosis.nominal_validation, validation);
    let found = diagnosis.chain.last().map(|last| &last.fit.model);
    let candidates = |list: &[Candidate]| -> Vec<Value> {
        list.iter().map(|candidate| candidate_json(candidate, before, validation, found)).collect()
    };
    let mut with_evidence = candidates(&diagnosis.candidates);
    // What has evidence beside the first only is a candidate too; its errors are before and after it was added there.
    let is_listed = |link: &Candidate| diagnosis.candidates.iter().any(|listed| listed.is_same_addition(link));
    let further = diagnosis.chain.windows(2).filter(|pair| !is_listed(&pair[1])).map(|pair| {
        let before = normalised_error(&pair[0].validation, validation);
        candidate_json(&pair[1], before, validation, found)
    });
    let after_the_first = with_evidence.len().min(1);
    with_evidence.splice(after_the_first..after_the_first, further);
    let places: Vec<Value> = diagnosis
        .map
        .iter()
        .map(|share| {
            json!({
                "equation": share.equation,
                "regime": share.regime,
                "share_of_residual": finite(share.share_of_residual),
                "share_of_time": finite(share.share_of_time),
            })
        })
        .collect();
    let chain: Vec<Value> = diagnosis
        .chain
        .iter()
        .map(|c| {
            json!({
                "effect": c.name(),
                "cylinder": c.place,
                "loss_after": finite(c.validation.loss()),
                "typical_loss_after": finite(c.validation.typical_loss()),
                "parameters": own_parameters(found.unwrap_or(&c.fit.model), c.name(), c.site),
            })
        })
        .collect();
    let instruments: Vec<Value> = diagnosis
        .nominal
        .instruments
        .iter()
        .map(|one| json!({"name": one.name, "noise": finite(one.noise), "unit": one.unit}))
        .collect();
    json!({
        "verdict": diagnosis.verdict.name(),
        "candidates": with_evidence,
        "rejected": candidates(&diagnosis.rejected),
        "together": chain,
        "fitted_along": along_json(given, found.unwrap_or(&diagnosis.nominal.model)),
        "where": places,
        "unexplained": diagnosis.unexplained.as_ref().map(|rest| json!({
            "equation": rest.equation,
            "variable": rest.variable,
            "share_of_residual": finite(rest.share_of_residual),
            "unit": rest.unit,
            "curve": rest.curve,
        })),
        "construction": diagnosis.construction.as_ref().map(|built| candidate_json(built, before, validation, None)),
        "adequate_by": diagnosis.adequacy.map(Adequacy::name),
        "too_coarse": diagnosis.too_coarse,
        "loss": {
            "nominal": finite(diagnosis.nominal_validation.loss()),
            "nominal_typical": finite(diagnosis.nominal_validation.typical_loss()),
        },
        "refitted": parameters(&diagnosis.nominal.model, &diagnosis.nominal.model.unknown_parameters()),
        "instruments": instruments,
    })
}

/// Result of `refine`.
pub fn refinement_json(refinement: &Refinement, model_file: &Path) -> Value {
    let steps: Vec<Value> = refinement
        .steps
        .iter()
        .map(|step| json!({"added": step.added, "signals": signals(&step.comparisons)}))
        .collect();
    json!({
        "verdict": refinement.verdict().name(),
        "steps": steps,
        "model": model_file.display().to_string(),
    })
}
