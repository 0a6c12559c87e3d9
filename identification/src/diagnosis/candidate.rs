//! Effects that a model may be missing, and their fits.

use excavator_model::effects::{self, Effect, Family, Site};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelError};

use super::Evidence;
use super::starts::starts;
use crate::fit::{Fit, FitError, FitSettings, fit};

/// A candidate that was tried.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The effect.
    pub physics: &'static dyn Effect,
    /// Where.
    pub site: Site,
    /// Name of the place: a cylinder, or "pump".
    pub place: String,
    /// Its fit to the identification recordings.
    pub fit: Fit,
    /// The same model on the validation recordings.
    pub validation: Fit,
    /// What it gains over the model without it, on the validation recordings.
    pub evidence: Evidence,
    /// What it gains on the identification recordings, where its parameters were fitted.
    pub identification_gain: f64,
    /// Whether the gain is large and certain enough, in both recordings.
    pub accepted: bool,
    /// Whether another candidate explains the recordings as well.
    pub tied_with_first: bool,
}

impl Candidate {
    /// Name in the catalogue.
    pub fn name(&self) -> &'static str {
        self.physics.card().name
    }
}

/// Every candidate effect at every place of the machine where it can act and is not yet.
pub fn additions(model: &Model) -> Vec<(&'static dyn Effect, Site)> {
    effects::CATALOGUE
        .iter()
        .copied()
        .filter(|effect| effect.card().family == Family::Candidate)
        .flat_map(|effect| model.free_sites(effect).into_iter().map(move |site| (effect, site)))
        .collect()
}

/// Why a candidate could not be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CandidateError {
    /// The effect does not fit the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It could not be fitted.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// Fits `model` with one more effect: a few steps from each start, then the best of them to the end.
///
/// # Errors
/// [`CandidateError`].
pub(crate) fn fit_addition(
    model: &Model,
    physics: &'static dyn Effect,
    site: Site,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, CandidateError> {
    let trial = try_starts(model, physics, site, recordings, &FitSettings { maximum_steps: 2, ..*settings })?;
    Ok(fit(&trial.model, recordings, settings)?)
}

/// The best of short fits from all starts of an addition.
///
/// # Errors
/// [`CandidateError`].
pub(super) fn try_starts(
    model: &Model,
    physics: &'static dyn Effect,
    site: Site,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, CandidateError> {
    let extended = model.with_effect(physics, site)?;
    let starts = starts(&extended, recordings);
    let regressed = starts.len() / 2;
    let mut best: Option<Fit> = None;
    let mut failure = None;
    for (number, start) in starts.iter().enumerate() {
        // Where a regression already led below the model without the effect, the plain starts can only cost time.
        let promising = best.as_ref().is_some_and(|best| best.loss() < settings.give_up_above);
        if promising && settings.give_up_above.is_finite() && number >= regressed {
            break;
        }
        match fit(start, recordings, settings) {
            Ok(trial) if best.as_ref().is_none_or(|best| trial.loss() < best.loss()) => best = Some(trial),
            Ok(_) => {}
            Err(error) => failure = Some(error),
        }
    }
    match (best, failure) {
        (Some(best), _) => Ok(best),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Err(FitError::TooShort.into()),
    }
}
