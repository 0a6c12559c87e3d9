//! Models with effects that act in a window of time, on recordings that they were not fitted to.
//!
//! A contact at 21 s of one recording says nothing about another. What it leaves of a model is judged with the window that
//! the other recording has itself: three numbers of a fit are no evidence against thousands of readings; whether they lower
//! the loss is.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::candidate::{CandidateError, best_start};
use super::starts::acts_in_a_window;
use crate::fit::{Fit, FitError, FitSettings, evaluate, fit, fit_predicted};

/// `model` on `recordings`, nothing fitted but the windows of its effects; where these are looked for first says `known`, the
/// model of an evaluation on the same recordings with some of the same effects.
///
/// # Errors
/// [`CandidateError`].
pub(super) fn evaluate_in_own_windows(
    model: &Model,
    known: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, CandidateError> {
    let acts = |model: &Model, effect: usize| {
        let effect = &model.effects[effect];
        acts_in_a_window(effect.physics, &model.machine, effect.site)
    };
    let mut model = model.clone();
    model.parameters_mut().for_each(|parameter| parameter.known = true);
    let mut has_known_windows = false;
    for index in 0..model.effects.len() {
        let own = &model.effects[index];
        let same = known.effects.iter().find(|other| other.name() == own.name() && other.site == own.site);
        if let Some(same) = same.filter(|_| acts(&model, index)) {
            has_known_windows = true;
            model.effects[index].parameters.clone_from(&same.parameters);
            model.effects[index].parameters.iter_mut().for_each(|parameter| parameter.known = false);
        }
    }
    let is_new = |last: &excavator_model::ModelEffect| !known.has(last.name(), last.site);
    let last = model.effects.len().saturating_sub(1);
    if model.effects.last().is_some_and(is_new) && acts(&model, last) {
        let Some(added) = model.effects.pop() else { return Ok(evaluate(&model, recordings, settings)?) };
        let start = best_start(&model, added.physics, added.site, recordings, settings)?;
        return Ok(fit_predicted(&start.model, start.promise, recordings, settings)?);
    }
    Ok(if has_known_windows { fit(&model, recordings, settings)? } else { evaluate(&model, recordings, settings)? })
}

/// The same for a model whose effects are all in `known`.
///
/// # Errors
/// [`FitError`].
pub(super) fn evaluate_in_known_windows(
    model: &Model,
    known: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, FitError> {
    match evaluate_in_own_windows(model, known, recordings, settings) {
        Ok(fit) => Ok(fit),
        Err(CandidateError::Fit(error)) => Err(error),
        // Nothing is added, so no effect can be refused.
        Err(CandidateError::Model(_)) => evaluate(model, recordings, settings),
    }
}
