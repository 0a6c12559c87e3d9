//! Effects that a model may be missing, and their fits.

use excavator_model::effects::{CATALOGUE, Effect, Family, Site};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelError, site_name};

use super::own_windows::has_window;
use super::starts::{acts_in_a_window, half_open, starts};
use super::{Evidence, Inclusion, compare_losses};
use crate::fit::{Fit, FitError, FitSettings, Prediction, fit_predicted, predict};
use crate::fitted_along::refitted_with_effects_along;

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
    /// How often it would have gained as much, or most, on stretches drawn from the validation recordings.
    pub inclusion: Inclusion,
    /// What it gains on the identification recordings, where its parameters were fitted.
    pub identification_gain: f64,
    /// Whether the gain is large and certain enough, in both recordings.
    pub accepted: bool,
    /// Whether another candidate explains the recordings as well.
    pub tied_with_first: bool,
}

impl Candidate {
    /// `physics` at `site`, the last effect of a model, fitted to the identification recordings and evaluated on the validation
    /// recordings, against `base`, the same of a model to compare it with. Not accepted yet, inclusion not counted.
    pub(super) fn new(physics: &'static dyn Effect, site: Site, [fit, validation]: [Fit; 2], base: [&Fit; 2]) -> Self {
        Self {
            physics,
            site,
            place: site_name(&fit.model.machine, site).to_string(),
            evidence: compare_losses(base[1], &validation),
            identification_gain: compare_losses(base[0], &fit).gain,
            fit,
            validation,
            inclusion: Inclusion::default(),
            accepted: false,
            tied_with_first: false,
        }
    }

    /// Name in the catalogue.
    pub fn name(&self) -> &'static str {
        self.physics.card().name
    }

    /// Number of its own parameters that were fitted.
    pub fn parameter_count(&self) -> usize {
        let own = self.fit.model.effects.last().map_or(&[][..], |effect| &effect.parameters);
        own.iter().filter(|parameter| !parameter.known).count()
    }

    /// Whether the recordings determine at least one of its own parameters.
    pub(super) fn is_determined(&self) -> bool {
        let own = self.fit.model.effects.last().map_or(0, |effect| effect.parameters.len());
        let (all, undetermined) = (self.fit.model.parameters().count(), self.fit.undetermined());
        self.fit.fitted.iter().any(|index| *index + own >= all && !undetermined.contains(index))
    }

    /// The fitted model without the candidate's own effect, nothing fitted again.
    pub fn without_effect(&self) -> Model {
        let mut model = self.fit.model.clone();
        // A candidate is added after everything that the model had.
        model.effects.pop();
        model
    }

    /// The fitted model, what acts in a window of time in that of the validation recordings.
    pub(super) fn model_on_validation(&self) -> Model {
        let mut model = self.fit.model.clone();
        if model.effects.iter().any(has_window) {
            model.set_parameter_values(&self.validation.model.parameter_values());
        }
        model
    }

    /// Whether both are the same effect at the same place, whatever their fits.
    pub fn is_same_addition(&self, other: &Candidate) -> bool {
        self.name() == other.name() && self.site == other.site
    }
}

/// An effect that was not worth a fit to the end.
#[derive(Debug, Clone)]
pub struct Unpromising {
    /// The effect.
    pub physics: &'static dyn Effect,
    /// Name of the place: a cylinder, or "pump".
    pub place: String,
    /// Fall of the loss on the identification recordings that its first step promised, or its first steps brought.
    pub promised_gain: f64,
}

/// Every candidate effect, and every loss of the nominal model, at every place of the machine where it can act and is not
/// yet.
pub fn additions(model: &Model) -> Vec<(&'static dyn Effect, Site)> {
    free_effects(model, |family| family.is_candidate())
}

/// Every effect of the families `wanted` at every place of the machine where it can act and is not yet.
pub(super) fn free_effects(model: &Model, wanted: impl Fn(Family) -> bool) -> Vec<(&'static dyn Effect, Site)> {
    CATALOGUE
        .iter()
        .copied()
        .filter(|effect| wanted(effect.card().family))
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

/// Fits `model` with one more effect, from the start that promises most.
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
    let start = best_start(model, physics, site, recordings, settings)?;
    Ok(fit_predicted(&start.model, start.promise, recordings, settings)?)
}

/// What [`fit_addition`] or a race made of a model whose last effect is an addition, with what the recordings show beside it of how
/// they were made: without it that was hidden under what was missing. An effect that acts in a window of time keeps its place.
pub(crate) fn addition_with_effects_along(fitted: Fit, recordings: &[&Recording], settings: &FitSettings) -> Fit {
    let model = &fitted.model;
    let Some(last) = model.effects.last() else { return fitted };
    if acts_in_a_window(last.physics, &model.machine, last.site) {
        return fitted;
    }
    let behind = model.effects.len() - 1;
    refitted_with_effects_along(fitted, behind, recordings, settings)
}

/// A start of a candidate's fit.
pub(super) struct PromisingStart {
    /// The model with the effect, at the start.
    pub model: Model,
    /// What one step from there promises.
    pub promise: Prediction,
}

/// The start of an addition whose first step promises most.
///
/// # Errors
/// [`CandidateError`].
pub(super) fn best_start(
    model: &Model,
    physics: &'static dyn Effect,
    site: Site,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<PromisingStart, CandidateError> {
    let extended = model.with_effect(physics, site)?;
    let mut best: Option<PromisingStart> = None;
    let mut failure = None;
    let mut try_one = |start: Model, best: &mut Option<PromisingStart>| match predict(&start, recordings, settings) {
        Ok(promise) if best.as_ref().is_none_or(|best| promise.loss_after < best.promise.loss_after) => {
            *best = Some(PromisingStart { model: start, promise });
        }
        Ok(_) => {}
        Err(error) => failure = Some(error),
    };
    for start in starts(&extended, recordings) {
        try_one(start, &mut best);
    }
    let half_open = best.as_ref().map_or_else(Vec::new, |best| half_open(&best.model));
    for start in half_open {
        try_one(start, &mut best);
    }
    match (best, failure) {
        (Some(best), _) => Ok(best),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Err(FitError::NoWindow.into()),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    #[test]
    fn how_a_machine_is_built_is_no_candidate() {
        let model = built_in("zx30u-arm").unwrap();
        let names: Vec<&str> = additions(&model).iter().map(|(effect, _)| effect.card().name).collect();
        assert!(names.contains(&"valve_dead_zone"), "{names:?}");
        assert!(!names.contains(&"pressure_compensation"), "{names:?}");
        assert_eq!(model.parse_addition("pressure_compensation@arm").unwrap().len(), 1);
    }
}
