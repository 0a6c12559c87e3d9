//! Judges effects that a user named.

use excavator_model::recording::Recording;

use crate::decision::{Kind, Policy, decide};
use crate::fit::{Fit, FitSettings};
use crate::search::{Addition, AdditionError, score_named};

/// Verdict on effects that a user named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NamedVerdict {
    /// `MissingEffect` if they explain what the model was missing, `Adequate` if it was missing nothing, `Unexplained` if
    /// something is still missing.
    pub kind: Kind,
    /// Decrease of the log error ratio on the validation recordings that they bring together.
    pub improvement: f64,
    /// Whether the improvement exceeds chance and the small errors that every model has.
    pub helps: bool,
}

/// Judges effects that were added to `given` one after the other, each with the fit that includes it, by the rules of a
/// diagnosis.
///
/// # Errors
/// [`AdditionError`] if a model cannot be evaluated on the validation recordings.
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
