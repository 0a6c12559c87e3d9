//! Effects that a model may be missing, and their fits.

use excavator_model::effects::{self, Effect, Family, Kind, Site, Start};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelError};

use super::Evidence;
use crate::fit::{Fit, FitError, FitSettings, fit};
use crate::regression::{WeakFormSettings, weak_form};

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

/// Fits `model` with one more effect: from each of the effect's start values, and from what a regression makes of them,
/// a few steps, then the best of them to the end.
pub(crate) fn fit_addition(
    model: &Model,
    physics: &'static dyn Effect,
    site: Site,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, CandidateError> {
    let extended = model.with_effect(physics, site)?;
    // A regression on the equations finds linear coefficients without a search, however far they are from any start.
    let quick = WeakFormSettings { rounds: 1, with_errors: false, ..WeakFormSettings::default() };
    let plain = starts(&extended, recordings);
    let regressed = plain
        .iter()
        .filter_map(|start| weak_form(start, recordings, &quick).ok())
        .map(|regression| within_bounds(regression.model));
    let trial_settings = FitSettings { maximum_steps: 2, ..*settings };
    let mut best: Option<Fit> = None;
    let mut failure = None;
    for (number, start) in regressed.chain(plain.iter().cloned()).enumerate() {
        // Where a regression already led below the model without the effect, the plain starts can only cost time.
        let promising = best.as_ref().is_some_and(|best| best.loss() < settings.give_up_above);
        if promising && settings.give_up_above.is_finite() && number >= plain.len() {
            break;
        }
        match fit(&start, recordings, &trial_settings) {
            Ok(trial) if best.as_ref().is_none_or(|best| trial.loss() < best.loss()) => best = Some(trial),
            Ok(_) => {}
            Err(error) => failure = Some(error),
        }
    }
    match (best, failure) {
        (Some(best), _) => Ok(fit(&best.model, recordings, settings)?),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Err(FitError::TooShort.into()),
    }
}

/// Unknown parameters moved to the nearest possible value.
fn within_bounds(mut model: Model) -> Model {
    for parameter in model.parameters_mut().filter(|parameter| !parameter.known) {
        parameter.value = parameter.value.clamp(parameter.card.minimum, parameter.card.maximum);
    }
    model
}

/// The model with the last effect's parameters at each combination of their start values.
fn starts(model: &Model, recordings: &[&Recording]) -> Vec<Model> {
    let mut starts = vec![model.clone()];
    let Some(last) = model.effects.last() else { return starts };
    for (number, parameter) in last.parameters.iter().enumerate() {
        let values: Vec<f64> = match parameter.card.start {
            Start::At(values) => values.to_vec(),
            Start::PumpPressureQuantiles(levels) => {
                levels.iter().map(|&level| pump_pressure(recordings, level)).collect()
            }
        };
        let values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        if parameter.card.kind != Kind::Shape && values.len() < 2 || values.is_empty() {
            continue;
        }
        starts = starts
            .iter()
            .flat_map(|start| {
                values.iter().map(|&value| {
                    let mut start = start.clone();
                    if let Some(effect) = start.effects.last_mut() {
                        effect.parameters[number].value = value;
                    }
                    start
                })
            })
            .collect();
    }
    starts
}

fn pump_pressure(recordings: &[&Recording], level: f64) -> f64 {
    let mut values: Vec<f64> = recordings
        .iter()
        .flat_map(|recording| recording.pump_pressure.iter().copied())
        .filter(|value| value.is_finite())
        .collect();
    if values.is_empty() {
        return f64::NAN;
    }
    let position = ((values.len() - 1) as f64 * level) as usize;
    *values.select_nth_unstable_by(position, f64::total_cmp).1
}
