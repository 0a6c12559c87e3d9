//! Results for programs.

use std::path::Path;

use excavator_identification::diagnosis::{Candidate, Diagnosis, Share, Unexplained};
use excavator_identification::fit::nuisances_shown;
use excavator_identification::regression::ConditionNumber;
use excavator_identification::validation::{
    Baseline, Baselines, Comparison, Correlation, PhaseShare, SignalComparison,
};
use excavator_identification::value_marks::value_mark;
use excavator_model::effects::Site;
use excavator_model::{Model, site_name};
use excavator_report::Beside;
use serde_json::{Map, Value, json};

use crate::cli::Overwriting;
use crate::error::VerbError;

/// Writes JSON to a file, or to standard output for "-".
pub fn write_json(path: &Path, value: &Value, overwriting: Overwriting) -> Result<(), VerbError> {
    crate::outputs::write(path, &(serde_json::to_string_pretty(value)? + "\n"), overwriting)
}

/// JSON has no NaN: what is not a number is null.
pub fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}

fn parameters(model: &Model, fitted: &[usize]) -> Vec<Value> {
    let names = model.parameter_names();
    model
        .parameters()
        .enumerate()
        .filter(|(index, _)| fitted.contains(index))
        .map(|(index, (_, parameter))| {
            let mut value = json!({
                "name": names[index],
                "value": finite(parameter.value),
                "std_error": parameter.standard_error.map_or(Value::Null, finite),
                "margin_95": parameter.margin_95.map_or(Value::Null, finite),
                "unit": parameter.card.unit,
            });
            if let Some(mark) = value_mark(model, index) {
                value["remark"] = json!(mark.to_string());
            }
            value
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
        let mut value = json!({
            "nmse": finite(nmse),
            "fit": finite(fit),
            "phase_delay_deg": delay,
            "autocorrelation": worst(own().filter_map(|s| s.autocorrelation).collect()),
            "input_correlation": worst(own().filter_map(|s| s.input_correlation).collect()),
        });
        if let [_] = comparisons {
            value["phases"] = signal.phases.iter().map(phase_json).collect();
        }
        (signal.name.clone(), value)
    });
    Value::Object(entries.collect())
}

fn phase_json(share: &PhaseShare) -> Value {
    json!({
        "phase": share.phase.to_string(),
        "share_of_time": finite(share.of_time),
        "share_of_error": finite(share.of_error),
    })
}

fn correlation(found: Correlation) -> Value {
    json!({"value": finite(found.value), "lag_s": finite(found.lag), "bound": finite(found.bound)})
}

/// Result of `compare`.
pub fn comparison_json(comparison: &Comparison, baselines: &Baselines, others: &[Beside<'_>]) -> Value {
    let of_signal = |(signal, baseline): (&SignalComparison, &Baseline)| {
        let value =
            json!({"noise": finite(baseline.noise), "arx": finite(baseline.arx), "held": finite(baseline.held)});
        (signal.name.clone(), value)
    };
    let each: Map<String, Value> = comparison.signals.iter().zip(&baselines.signals).map(of_signal).collect();
    let beside = |is_run: bool| {
        let found = others.iter().find(|other| matches!(other, Beside::Run(_)) == is_run);
        found.map_or(Value::Null, |other| {
            let own = other.comparison();
            json!({"mean_nmse": finite(own.mean_error()), "signals": signals(std::slice::from_ref(own))})
        })
    };
    json!({
        "mean_nmse": finite(comparison.mean_error()),
        "against": beside(false),
        "repeat": beside(true),
        "signals": signals(std::slice::from_ref(comparison)),
        "baseline_nmse": {
            "held_s": baselines.held,
            "signals": each,
        },
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

/// One candidate. `found` is the favoured model: where the candidate is a part of it its parameters are those beside the others, which
/// one alone had to stand in for.
fn candidate_json(candidate: &Candidate<'_>, found: &Model) -> Value {
    let (alone, site) = (&candidate.trial.fit.model, candidate.addition.site);
    let model = Some(found).filter(|model| model.has(candidate.name(), site)).unwrap_or(alone);
    let standing = candidate.standing;
    json!({
        "effect": candidate.name(),
        "cylinder": candidate.place(),
        "validation_error_before": finite(candidate.errors[0]),
        "validation_error_after": finite(candidate.errors[1]),
        "evidence": finite(candidate.improvement),
        "significance": finite(standing.significance),
        "set_p_value": standing.set_p_value.map(finite),
        "bootstrap": {"is_first": finite(standing.is_first)},
        "log_error_ratio": finite(standing.log_error_ratio),
        "tied_with_first": candidate.is_tied_with_first,
        "parameters": own_parameters(model, candidate.name(), site),
        "refitted": parameters(model, &model.unknown_parameters()),
    })
}

/// Nuisance effects that were estimated in `fitted`, a model that began as `given`.
fn nuisances_json(given: &Model, fitted: &Model) -> Vec<Value> {
    nuisances_shown(given, fitted)
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
pub fn diagnosis_json(given: &Model, diagnosis: &Diagnosis) -> Value {
    let found = &diagnosis.best().fit.model;
    let supported = &diagnosis.supported().fit.model;
    let listed = |list: &[Candidate<'_>]| -> Vec<Value> {
        list.iter().map(|candidate| candidate_json(candidate, found)).collect()
    };
    // A structural alternative is no candidate: a verdict does not name it.
    let is_candidate = |one: &Candidate<'_>| one.addition.physics.card().family.is_candidate();
    let candidates: Vec<Candidate<'_>> = diagnosis.candidates().into_iter().filter(is_candidate).collect();
    let construction = diagnosis.verdict.structural_alternative().and_then(|number| {
        let trial = &diagnosis.trials[number];
        let structural = trial.additions.iter().find(|one| !one.physics.card().family.is_candidate())?;
        Some(json!({
            "effect": structural.physics.card().name,
            "cylinder": site_name(&trial.fit.model.machine, structural.site),
            "validation_error_after": finite(diagnosis.error_of(trial)),
            "parameters": own_parameters(&trial.fit.model, &structural.physics.card().name, structural.site),
        }))
    });
    let given_trial = diagnosis.given();
    json!({
        "verdict": diagnosis.verdict.kind.name(),
        "reasons": diagnosis.verdict.reasons,
        "validation_error": {
            "before": finite(diagnosis.error_of(given_trial)),
            "after": finite(diagnosis.error_of(diagnosis.supported())),
        },
        "candidates": listed(&candidates),
        "rejected": listed(&diagnosis.rejected()),
        "together": together_json(diagnosis),
        "nuisances": nuisances_json(given, supported),
        "where": where_json(diagnosis),
        "unexplained": diagnosis.unexplained.as_ref().map(unexplained_json),
        "construction": construction,
        "too_coarse": diagnosis.verdict.is_too_coarse(),
        "log_error_ratio": finite(diagnosis.verdict.standings[0].log_error_ratio),
        "refitted": parameters(&given_trial.fit.model, &given_trial.fit.model.unknown_parameters()),
        "instruments": instruments_json(diagnosis),
    })
}

/// What is left, as a curve.
pub(super) fn unexplained_json(rest: &Unexplained) -> Value {
    json!({
        "equation": rest.equation,
        "variable": rest.variable,
        "share_of_residual": finite(rest.share_of_residual),
        "unit": rest.unit,
        "curve": rest.curve,
    })
}

/// The selected effects, one after the other, with their parameters in the model that has them all.
fn together_json(diagnosis: &Diagnosis) -> Vec<Value> {
    let model = &diagnosis.supported().fit.model;
    let selected = diagnosis.selected().into_iter();
    selected
        .map(|one| {
            json!({
                "effect": one.name(),
                "cylinder": one.place(),
                "log_error_ratio_after": finite(one.standing.log_error_ratio),
                "parameters": own_parameters(model, one.name(), one.addition.site),
            })
        })
        .collect()
}

fn where_json(diagnosis: &Diagnosis) -> Vec<Value> {
    let share = |share: &Share| {
        json!({
            "equation": share.equation,
            "regime": share.regime,
            "share_of_residual": finite(share.share_of_residual),
            "share_of_time": finite(share.share_of_time),
        })
    };
    diagnosis.map.iter().map(share).collect()
}

fn instruments_json(diagnosis: &Diagnosis) -> Vec<Value> {
    let instruments = diagnosis.given().fit.instruments.iter();
    instruments.map(|one| json!({"name": one.name, "noise": finite(one.noise), "unit": one.unit})).collect()
}

/// Result of `refine`: what was added at each step, and how the model then compares.
pub fn refinement_json<'s>(
    verdict: &str,
    steps: impl Iterator<Item = (Option<&'s str>, &'s [Comparison])>,
    model_file: &Path,
) -> Value {
    let steps: Vec<Value> =
        steps.map(|(added, comparisons)| json!({"added": added, "signals": signals(comparisons)})).collect();
    json!({
        "verdict": verdict,
        "steps": steps,
        "model": model_file.display().to_string(),
    })
}
