//! The given model, fitted.

use std::time::Instant;

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::pool::Pool;
use super::starts::within_bounds;
use super::{Effort, Trial};
use crate::fit::{Fit, FitError, FitSettings, evaluate, fit, with_nuisances};
use crate::regression::{WeakFormSettings, weak_form};

/// Trials of which the next one is looked at for a better fit of the given model.
const LOOKED_AT: usize = 3;

/// Loss up to which a fit that a regression has started is trusted: 1.2 times the noise variance. Above it something may be missing, or an
/// instrument that is far off may have led the regression astray, and the given values are tried as a start too.
const TRUSTED_LOSS: f64 = 0.2;

/// Fits a model's unknown parameters and its nuisances, starting from a regression where one is possible.
///
/// # Errors
/// [`FitError`].
pub(crate) fn fit_given(model: &Model, identification: &[&Recording], settings: &FitSettings) -> Result<Fit, FitError> {
    let model = &with_nuisances(model, identification);
    let quick =
        WeakFormSettings { rounds: 2, with_errors: false, hold_at_bounds: false, ..WeakFormSettings::default() };
    let regressed = weak_form(model, identification, &quick)
        .map(|regression| within_bounds(regression.model))
        .ok()
        .and_then(|start| fit(&start, identification, settings).ok());
    match regressed {
        Some(fitted) if fitted.loss() <= TRUSTED_LOSS => Ok(fitted),
        regressed => match (regressed, fit(model, identification, settings)) {
            (Some(first), Ok(second)) if first.loss() <= second.loss() => Ok(first),
            (Some(first), Err(_)) => Ok(first),
            (_, second) => second,
        },
    }
}

/// A fit of the given model as the first trial.
///
/// # Errors
/// [`FitError`] when it cannot be evaluated on the validation recordings.
pub(super) fn given_trial(fit: Fit, validation: &[&Recording], settings: &FitSettings) -> Result<Trial, FitError> {
    let begin = Instant::now();
    let evaluated = evaluate(&fit.model, validation, settings)?;
    let seconds = begin.elapsed().as_secs_f64();
    Ok(Trial { additions: Vec::new(), fit, validation: evaluated, seconds })
}

/// A better fit of the given model, to which an addition has led. Where the fit of the given model ended in the wrong valley, whatever is
/// added improves it by leaving that valley, an effect of size zero too. Such an addition without its effect is the better fit, and
/// no evidence for the effect.
pub(super) fn better_given(pool: &Pool<'_>, effort: &Effort) -> Option<Fit> {
    let identification = pool.identification();
    let largest = pool.given().fit.loss() - effort.restart_improvement;
    let mut singles: Vec<&Trial> = pool.trials.iter().filter(|trial| trial.additions.len() == 1).collect();
    singles.sort_by(|a, b| a.fit.loss().total_cmp(&b.fit.loss()));
    singles
        .into_iter()
        .filter(|trial| trial.fit.loss() < largest)
        .take(LOOKED_AT)
        .filter_map(|trial| {
            let without = trial.model_without(trial.additions.first()?);
            // Of a real effect nothing good is left without it.
            let start = evaluate(&without, identification, &effort.fit).ok()?;
            (start.loss() < largest).then_some(())?;
            fit(&without, identification, &effort.fit).ok()
        })
        .filter(|better| better.loss() < largest)
        .min_by(|a, b| a.loss().total_cmp(&b.loss()))
}
