//! What effects that somebody named do for a model.

use excavator_model::recording::Recording;

use crate::decision::{Kind, Policy, decide};
use crate::fit::{Fit, FitSettings};
use crate::search::{Addition, AdditionError, score_named};

/// What is to be thought of effects that were added because somebody named them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedVerdict {
    /// `MissingEffect` where they explain what the model was missing, `Adequate` where it was missing nothing, `Unexplained`
    /// where something is missing still.
    pub kind: Kind,
    /// Fall of the log error ratio on the validation recordings that they bring together.
    pub improvement: f64,
    /// Whether that is more than chance and the small errors that every model has.
    pub helps: bool,
}

/// Judges effects that were added to `given` one after the other, each with the fit that ends with it, by the rules of a diagnosis.
///
/// # Errors
/// [`AdditionError`] when a model cannot be evaluated on the validation recordings.
pub(crate) fn judge_named(
    given: &Fit,
    added: &[(Addition, Fit)],
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &FitSettings,
    policy: &Policy,
) -> Result<NamedVerdict, AdditionError> {
    let scores = score_named(given, added, identification, validation, settings, policy)?;
    let verdict = decide(&scores, policy);
    let last = verdict.standings[verdict.standings.len() - 1];
    let helps = !added.is_empty()
        && last.improvement >= policy.least_improvement
        && last.significance >= policy.least_significance;
    Ok(NamedVerdict { kind: verdict.kind, improvement: last.improvement, helps })
}
