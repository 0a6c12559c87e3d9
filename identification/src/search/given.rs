//! Fits the given model.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::pool::Pool;
use super::starts::within_bounds;
use super::{Effort, Trial};
use crate::fit::{Fit, FitError, FitSettings, evaluate, fit, with_nuisances};
use crate::regression::{WeakFormSettings, weak_form};

/// Number of trials that are checked for a better fit of the given model.
const LOOKED_AT: usize = 3;

/// Loss up to which a fit that was started from a regression is trusted: 1.2 times the noise variance. Above it
/// something may be missing, or an instrument with a large error may have biased the regression. The given values are
/// then tried as a start too.
const TRUSTED_LOSS: f64 = 0.2;

/// A fit of the given model, and whether another start could lead to a better one.
pub(super) struct First {
    /// The fit.
    pub fit: Fit,
    /// Whether nothing is gained from another start.
    pub is_trusted: bool,
}

/// Fits a model's unknown parameters and its nuisances, starting from a regression if one is possible. Inertias and bulk moduli stay
/// within what the given values allow.
///
/// # Errors
/// [`FitError`].
pub(crate) fn fit_given(model: &Model, identification: &[&Recording], settings: &FitSettings) -> Result<Fit, FitError> {
    let model = &model.clone().with_limits_around_given();
    let First { fit: first, is_trusted } = first_fit(model, identification, settings)?;
    let second = if is_trusted { None } else { second_fit(model, identification, settings, first.loss()) };
    Ok(second.unwrap_or(first))
}

/// The fit of the given model that starts from a regression, or from the given values if no regression is possible.
///
/// # Errors
/// [`FitError`].
pub(super) fn first_fit(
    model: &Model,
    identification: &[&Recording],
    settings: &FitSettings,
) -> Result<First, FitError> {
    let model = &with_nuisances(model, identification);
    let quick =
        WeakFormSettings { rounds: 2, with_errors: false, hold_at_bounds: false, ..WeakFormSettings::default() };
    let regressed = weak_form(model, identification, &quick)
        .map(|regression| within_bounds(regression.model))
        .ok()
        .and_then(|start| fit(&start, identification, settings).ok());
    match regressed {
        Some(fit) => Ok(First { is_trusted: fit.loss() <= TRUSTED_LOSS, fit }),
        None => Ok(First { fit: fit(model, identification, settings)?, is_trusted: true }),
    }
}

/// The fit that starts from the given values, if its loss is below that of the first.
pub(super) fn second_fit(
    model: &Model,
    identification: &[&Recording],
    settings: &FitSettings,
    first: f64,
) -> Option<Fit> {
    fit(&with_nuisances(model, identification), identification, settings).ok().filter(|second| second.loss() < first)
}

/// A better fit of the given model that was found through an addition. If the fit of the given model ended in a local
/// minimum, any addition can improve it by leaving that minimum, even an effect of size zero. Such a model without its
/// addition is the better fit, and no evidence for the effect.
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
            // Without a real effect the loss would not stay this low.
            let start = evaluate(&without, identification, &effort.fit).ok()?;
            (start.loss() < largest).then_some(())?;
            fit(&without, identification, &effort.fit).ok()
        })
        .filter(|better| better.loss() < largest)
        .min_by(|a, b| a.loss().total_cmp(&b.loss()))
}
