//! What named additions did, in plain sentences.

use super::numbers::ratio;
use super::plausibility_text::implausible_sentence;
use super::signal_tables::added_name;
use super::verdict_text::verdict_sentence;
use super::words;
use crate::decision::Kind;
use crate::diagnosis::NamedVerdict;
use crate::refinement::{Reason, Refinement};

/// What a refinement came to, in one or two plain sentences: the verdict of its diagnosis, or what named additions did.
pub fn refinement_sentence(refinement: &Refinement) -> String {
    match &refinement.reason {
        Reason::Found(diagnosis) => verdict_sentence(&refinement.given_model, diagnosis),
        Reason::Named(named) => {
            let added: Vec<String> = refinement.steps.iter().filter_map(|step| step.added.clone()).collect();
            let told = named_sentence(&added, named);
            let implausible = implausible_sentence(&refinement.given_model, &refinement.model);
            implausible.map_or(told.clone(), |sentence| format!("{told} {sentence}"))
        }
    }
}

fn named_sentence(added: &[String], named: &NamedVerdict) -> String {
    let names: Vec<String> = added.iter().map(|name| added_name(name)).collect();
    let it = if names.len() == 1 { "it" } else { "them" };
    let asked = match names.as_slice() {
        [] => "The parameters were identified again; nothing was added.".to_string(),
        names => format!("Added as asked: {}.", words::list(names, "and")),
    };
    let times = ratio(named.improvement.exp());
    let became =
        format!("With {it} the squared error on recordings the model was not fitted to becomes {times} times smaller");
    let told = match named.kind {
        Kind::MissingEffect => format!("{became}, and that explains what the model was missing."),
        Kind::Adequate => {
            format!("The model was adequate without {it}: the error that was left says nothing of {it}.")
        }
        Kind::Unexplained if named.helps => {
            format!("{became}, but something is missing still; `excavator diagnose` looks for it.")
        }
        Kind::Unexplained => format!(
            "That does not help: with {it} the squared error on recordings the model was not fitted to is {}. Something else is missing; \
             `excavator diagnose` looks for it.",
            if named.improvement < 0.0 { "larger" } else { "no smaller than chance makes it" }
        ),
    };
    match (names.is_empty(), named.kind) {
        (false, _) => format!("{asked} {told}"),
        (true, Kind::Unexplained) => format!("{asked} Something is missing; `excavator diagnose` looks for it."),
        (true, _) => format!("{asked} The model is adequate."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    fn told(added: &[&str], kind: Kind, improvement: f64, helps: bool) -> String {
        let added: Vec<String> = added.iter().map(ToString::to_string).collect();
        named_sentence(&added, &NamedVerdict { kind, improvement, helps })
    }

    #[test]
    fn an_effect_that_does_not_help_is_not_called_adequate() {
        let wrong = told(&["stribeck_friction@arm"], Kind::Unexplained, -0.02, false);
        assert!(wrong.contains("does not help") && wrong.contains("larger") && wrong.contains("excavator diagnose"));
        let half = told(&["valve_lag@arm"], Kind::Unexplained, 2.0, true);
        assert!(half.contains("7.39 times smaller, but something is missing still"));
        let right = told(&["valve_dead_zone@arm", "hose_loss@arm"], Kind::MissingEffect, 5.0, true);
        assert!(right.contains("With them") && right.contains("148 times smaller") && right.contains("explains"));
        assert!(told(&["payload@arm"], Kind::Adequate, 0.0, false).contains("was adequate without it"));
        assert!(told(&[], Kind::Unexplained, 0.0, false).contains("Something is missing"));
    }
}
