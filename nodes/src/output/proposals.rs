//! Proposed laws for people and for programs.

use comfy_table::{Cell, ContentArrangement, Table};
use excavator_identification::proposal::{Finding, Guess, Proposal, ProposalVerdict, Proposals};
use excavator_model::Model;
use excavator_report::{law_remarks, law_result};
use serde_json::{Value, json};

use super::json::{diagnosis_json, finite, unexplained_json};
use super::tables::{number, right, table};

/// Proposals, the best first.
pub fn proposal_table(found: &Proposals) -> Table {
    let mut table = table(&["law", "acts on", "at", "numbers", "NMSE before", "NMSE after", "result", "remarks"]);
    table.set_content_arrangement(ContentArrangement::Dynamic);
    for proposal in &found.proposals {
        let free = proposal.effect.parameters.iter().filter(|parameter| !parameter.known);
        let numbers: Vec<String> =
            free.map(|parameter| format!("{} = {}", parameter.card.name, number(parameter.value))).collect();
        table.add_row([
            Cell::new(&proposal.text.formula),
            Cell::new(proposal.text.acts_on.replace('_', " ")),
            Cell::new(&proposal.place),
            Cell::new(numbers.join(", ")),
            right(number(found.error_before)),
            right(number(proposal.validation_error)),
            Cell::new(law_result(found, proposal)),
            Cell::new(law_remarks(proposal).join("; ")),
        ]);
    }
    table
}

/// What single terms promise.
pub fn guess_json(guess: &Guess) -> Value {
    json!({
        "formula": guess.text.formula,
        "acts_on": guess.text.acts_on,
        "at": guess.place,
        "parameters": guess.text.parameters.iter().map(|(name, parameter)| json!({
            "name": name,
            "value": parameter.start.first(),
            "unit": parameter.unit,
        })).collect::<Vec<_>>(),
        "promised_improvement": finite(guess.improvement),
    })
}

fn findings(findings: &[Finding]) -> Vec<Value> {
    findings.iter().map(|one| json!({"name": one.name, "share": finite(one.share)})).collect()
}

/// Result of `propose`.
pub fn proposal_json(model: &Model, found: &Proposals) -> Value {
    let is_law = found.kind == ProposalVerdict::Law;
    let first = found.proposals.first().map(|first| first.trial);
    let proposal = |one: &Proposal| {
        let free = one.effect.parameters.iter().filter(|parameter| !parameter.known);
        let parameters: Vec<Value> = free
            .map(|parameter| {
                json!({
                    "name": parameter.card.name,
                    "value": finite(parameter.value),
                    "std_error": parameter.standard_error.map_or(Value::Null, finite),
                    "margin_95": parameter.margin_95.map_or(Value::Null, finite),
                    "unit": parameter.card.unit,
                })
            })
            .collect();
        json!({
            "name": one.text.name,
            "acts_on": one.text.acts_on,
            "at": one.place,
            "formula": one.text.formula,
            "parameters": parameters,
            "beside": one.beside,
            "validation_error_before": finite(found.error_before),
            "validation_error_after": finite(one.validation_error),
            "evidence": finite(one.evidence),
            "tied_with_first": is_law && one.is_in_set && Some(one.trial) != first,
            "dissipates": one.merits.dissipates,
            "is_a_curve": one.is_a_curve,
            "remarks": law_remarks(one),
        })
    };
    let of_catalogue = diagnosis_json(model, &found.diagnosis);
    json!({
        "verdict": found.kind.name(),
        "proposals": found.proposals.iter().map(proposal).collect::<Vec<_>>(),
        "unexplained": found.lacking.as_ref().map(unexplained_json),
        "enters": findings(&found.survey.rows),
        "depends_on": findings(&found.survey.variables),
        "candidates": of_catalogue["candidates"],
        "reasons": of_catalogue["reasons"],
    })
}
