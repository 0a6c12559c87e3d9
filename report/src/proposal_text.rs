//! Describes the result of a search for laws in plain sentences.

use excavator_identification::proposal::{Guess, Proposal, ProposalVerdict, Proposals};
use excavator_model::Model;

use super::numbers::{change_of_error, percent, significant, with_margin};
use super::verdict_text::verdict_sentence;
use super::words;

/// Result of a search for laws, in a few sentences.
pub fn proposal_sentence(model: &Model, found: &Proposals) -> String {
    let machine = &model.machine.name;
    let mut sentences = Vec::new();
    match (found.kind, found.proposals.first()) {
        (ProposalVerdict::Adequate | ProposalVerdict::MissingEffect, _) => {
            sentences.push("No law is proposed: the catalogue is enough.".to_string());
            sentences.push(verdict_sentence(model, &found.diagnosis));
        }
        (ProposalVerdict::Law, Some(first)) => {
            sentences.push(format!("A law explains what {machine} is missing: {}.", law(first)));
            sentences.push(smaller(found, first));
            let alike = found.proposals.iter().skip(1).filter(|other| other.is_in_set && other.trial != first.trial);
            let alike: Vec<String> = alike.map(|other| other.text.formula.clone()).collect();
            if !alike.is_empty() {
                sentences.push(format!("These recordings cannot tell it from {}.", words::list(&alike, "or")));
            }
        }
        (_, first) => {
            sentences.push(format!("Something is missing in {machine}, and no law of the grammar explains it."));
            match first.filter(|first| !first.is_a_curve) {
                Some(first) => {
                    sentences.push(format!("The law that comes nearest is {}.", law(first)));
                    sentences.push(smaller(found, first));
                }
                None => sentences.push("No law comes near.".to_string()),
            }
            if let Some(curve) = found.proposals.iter().find(|proposal| proposal.is_a_curve) {
                sentences.push(format!(
                    "You can add a table of the curve, {}: it lowers the error and explains nothing.",
                    curve.text.name
                ));
            }
        }
    }
    sentences.extend(lacking(found));
    sentences.join(" ")
}

/// Prediction for the most promising single term.
pub fn guess_sentence(guess: &Guess) -> String {
    let text = &guess.text;
    let number = |(name, parameter): (&String, &excavator_model::formula::ParameterText)| {
        let start = parameter.start.first().copied().unwrap_or(f64::NAN);
        let unit = if parameter.unit == "-" { String::new() } else { format!(" {}", parameter.unit) };
        format!("{name} near {}{unit}", significant(start, 3))
    };
    let numbers: Vec<String> = text.parameters.iter().map(number).collect();
    format!(
        "The most promising single term is {} = {} at the {}, with {}. It has not been fitted or judged.",
        words::spoken(&text.acts_on),
        text.formula,
        guess.place,
        words::list(&numbers, "and")
    )
}

/// The formula, its place and its fitted numbers.
pub(super) fn law(proposal: &Proposal) -> String {
    let numbers: Vec<String> = numbers(proposal);
    format!(
        "{} = {} at the {}, with {}",
        words::spoken(&proposal.text.acts_on),
        proposal.text.formula,
        proposal.place,
        words::list(&numbers, "and")
    )
}

/// Fitted numbers with their 95 % intervals.
pub(super) fn numbers(proposal: &Proposal) -> Vec<String> {
    let free = proposal.effect.parameters.iter().filter(|parameter| !parameter.known);
    let number = |parameter: &excavator_model::Parameter| {
        let unit = if parameter.card.unit == "-" { String::new() } else { format!(" {}", parameter.card.unit) };
        format!(
            "{} = {}{unit}",
            parameter.card.name,
            with_margin(parameter.value, parameter.margin_95.unwrap_or(f64::NAN))
        )
    };
    free.map(number).collect()
}

fn smaller(found: &Proposals, proposal: &Proposal) -> String {
    let change = change_of_error([found.error_before, proposal.validation_error]);
    let with = if proposal.beside.is_empty() {
        String::new()
    } else {
        format!(" and {}", words::list(&proposal.beside, "and"))
    };
    format!("With it{with}, the mean NMSE on recordings that were not fitted {change}.")
}

/// The equation and the variable with which the model fails.
fn lacking(found: &Proposals) -> Option<String> {
    let left = found.lacking.as_ref()?;
    let without = if found.proposals.is_empty() { "The" } else { "Without it the" };
    Some(format!(
        "{without} {} is off, and {} of its squared residual follows the {}.",
        words::equation(&left.equation),
        percent(left.share_of_residual),
        words::variable(&left.variable)
    ))
}
