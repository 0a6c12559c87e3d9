//! Whether a verdict holds where the same model has other parameters in other recordings.

use excavator_model::recording::Recording;

use super::DiagnosisSettings;
use crate::change::{Changes, between, drift};
use crate::decision::{Differing, Kind, Reason, Verdict};
use crate::search::Pool;

/// The verdict, unless the parameters of the given model contradict it. A model is not adequate if its parameters drift from the
/// first halves to the second halves of the recordings. Nothing is missing of what a catalogue has if the recordings that were fitted
/// and those that judge leave only noise, each with parameters of its own.
pub(crate) fn confirmed(pool: &Pool<'_>, verdict: Verdict, settings: &DiagnosisSettings) -> Verdict {
    let (fit, limits) = (&pool.given().fit, &settings.effort.fit);
    let (fitted, judging) = (pool.identification(), pool.validation());
    match verdict.kind {
        Kind::Adequate => {
            let all: Vec<&Recording> = fitted.iter().chain(judging).copied().collect();
            // A half that does not suffice for a fit contradicts nothing.
            let found = drift(fit, &all, limits).ok();
            let parameters = found.map_or(Vec::new(), |found| differing(&found));
            unless(verdict, parameters, |parameters| Reason::ParametersDrift { parameters })
        }
        Kind::Unexplained => {
            let found = between(fit, fitted, judging, limits).ok();
            let found = found.filter(|found| found.leaves_more_than_noise() == [false, false]);
            let parameters = found.map_or(Vec::new(), |found| differing(&found));
            unless(verdict, parameters, |parameters| Reason::MachineDiffers { parameters })
        }
        Kind::MissingEffect => verdict,
    }
}

/// The verdict with a reason more, and so unexplained by the given model, if there are such parameters.
fn unless(verdict: Verdict, parameters: Vec<Differing>, reason: impl Fn(Vec<Differing>) -> Reason) -> Verdict {
    if parameters.is_empty() {
        return verdict;
    }
    let mut reasons = vec![reason(parameters)];
    reasons.extend(verdict.reasons);
    Verdict { kind: Kind::Unexplained, reasons, ..verdict }
}

fn differing(found: &Changes) -> Vec<Differing> {
    let each = found.changed().map(|one| Differing {
        name: one.name.clone(),
        meaning: one.meaning.clone(),
        unit: one.unit.clone(),
        values: one.values,
        difference_margin_95: one.margin_95(),
    });
    each.collect()
}
