//! Describes the result of named additions in plain sentences.

use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::NamedVerdict;
use excavator_identification::refinement::{Reason, Refinement, Step};

use super::numbers::change_of_error;
use super::plausibility_text::implausible_sentence;
use super::signal_tables::added_name;
use super::verdict_text::verdict_sentence;
use super::words;

/// Result of a refinement in one or two plain sentences: the verdict of its diagnosis, or the result of named
/// additions.
pub fn refinement_sentence(refinement: &Refinement) -> String {
    match &refinement.reason {
        Reason::Found(diagnosis) => verdict_sentence(&refinement.given_model, diagnosis),
        Reason::Named(named) => {
            let added: Vec<String> = refinement.steps.iter().filter_map(|step| step.added.clone()).collect();
            let errors =
                [refinement.steps.first(), refinement.steps.last()].map(|step| step.map_or(f64::NAN, Step::mean_error));
            let told = named_sentence(&added, named, errors);
            let implausible = implausible_sentence(&refinement.given_model, &refinement.model);
            implausible.map_or(told.clone(), |sentence| format!("{told} {sentence}"))
        }
    }
}

fn named_sentence(added: &[String], named: &NamedVerdict, errors: [f64; 2]) -> String {
    let names: Vec<String> = added.iter().map(|name| added_name(name)).collect();
    let it = if names.len() == 1 { "it" } else { "them" };
    let asked = match names.as_slice() {
        [] => "The parameters were identified again; nothing was added.".to_string(),
        names => format!("Added as asked: {}.", words::list(names, "and")),
    };
    let became = format!("With {it} the mean NMSE on recordings that were not fitted {}", change_of_error(errors));
    let told = match named.kind {
        Kind::MissingEffect => format!("{became}. That explains what the model was missing."),
        Kind::Adequate => {
            format!("The model was already adequate without {it}, so there is no evidence for {it}.")
        }
        Kind::Unexplained if named.helps => {
            format!("{became}. Something is still missing; run `excavator diagnose` to find it.")
        }
        Kind::Unexplained if named.improvement < 0.0 => {
            format!("That does not help. {became}. Something else is missing; run `excavator diagnose` to find it.")
        }
        Kind::Unexplained => format!(
            "That does not help. {became}. This change is not significant. Something else is missing; run `excavator diagnose` to find it."
        ),
    };
    match (names.is_empty(), named.kind) {
        (false, _) => format!("{asked} {told}"),
        (true, Kind::Unexplained) => format!("{asked} Something is missing; run `excavator diagnose` to find it."),
        (true, _) => format!("{asked} The model is adequate."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    fn told(added: &[&str], kind: Kind, improvement: f64, helps: bool) -> String {
        let added: Vec<String> = added.iter().map(ToString::to_string).collect();
        named_sentence(&added, &NamedVerdict { kind, improvement, helps }, [1.0, (-improvement).exp()])
    }

    #[test]
    fn an_effect_that_does_not_help_is_not_called_adequate() {
        let wrong = told(&["stribeck_friction@arm"], Kind::Unexplained, -0.02, false);
        assert!(
            wrong.contains("does not help")
                && wrong.contains("goes from 1.00 to 1.02")
                && wrong.contains("excavator diagnose")
        );
        let half = told(&["valve_lag@arm"], Kind::Unexplained, 2.0, true);
        assert!(half.contains("7.39 times smaller). Something is still missing"));
        let right = told(&["valve_dead_zone@arm", "hose_loss@arm"], Kind::MissingEffect, 5.0, true);
        assert!(right.contains("With them") && right.contains("148 times smaller") && right.contains("explains"));
        assert!(told(&["payload@arm"], Kind::Adequate, 0.0, false).contains("was already adequate without it"));
        assert!(told(&[], Kind::Unexplained, 0.0, false).contains("Something is missing"));
    }
}
