//! Evaluates transient effects on recordings that they were not fitted to.
//!
//! A contact at 21 s of one recording is not evidence about another. A model with a transient effect is judged with an
//! active window that is found in the other recording itself.

use excavator_model::recording::Recording;
use excavator_model::{Model, ModelEffect};

use super::addition::{Addition, AdditionError, best_start};
use crate::fit::{Fit, FitError, FitSettings, evaluate, fit, fit_predicted};

/// Evaluates `model` on `recordings`, with only the windows of its effects fitted. Start values come from `known`, the
/// model of an evaluation on the same recordings. The window of a last effect that `known` lacks is searched.
///
/// # Errors
/// [`AdditionError`].
pub(super) fn evaluate_on_others(
    model: &Model,
    known: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, AdditionError> {
    let is_new = |last: &&ModelEffect| !known.has(last.name(), last.site) && is_transient(last);
    let Some(added) = model.effects.last().filter(is_new) else {
        return Ok(evaluate_in_windows_of(model, known, recordings, settings)?);
    };
    let (mut without, _) = in_windows_of(model, known);
    without.effects.pop();
    let addition = Addition { physics: added.physics.clone(), site: added.site };
    let start = best_start(&without, &addition, recordings, None, settings)?;
    Ok(fit_predicted(&start.model, start.promise, recordings, settings)?)
}

/// The same for a model whose transient effects are all in `known`.
///
/// # Errors
/// [`FitError`].
pub(super) fn evaluate_in_windows_of(
    model: &Model,
    known: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, FitError> {
    let (model, any_transient) = in_windows_of(model, known);
    if any_transient { fit(&model, recordings, settings) } else { evaluate(&model, recordings, settings) }
}

/// `model` with the windows of `known` and only these effects free, and whether there are any.
fn in_windows_of(model: &Model, known: &Model) -> (Model, bool) {
    let mut in_windows = model.clone();
    in_windows.parameters_mut().for_each(|parameter| parameter.known = true);
    let mut any = false;
    for (effect, fitted) in in_windows.effects.iter_mut().zip(&model.effects) {
        let Some(same) =
            known.effect(effect.name(), effect.site).filter(|same| is_transient(fitted) && is_transient(same))
        else {
            continue;
        };
        any = true;
        effect.parameters.clone_from(&same.parameters);
    }
    (in_windows, any)
}

/// Whether the effect acts in a window that was searched.
pub(super) fn is_transient(effect: &ModelEffect) -> bool {
    effect.parameters.iter().any(|parameter| parameter.card.start.is_a_time() && !parameter.known)
}
