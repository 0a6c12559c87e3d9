//! Additions to a model.

use excavator_model::effects::{AnyEffect, Family, Site};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelError, addition_name, site_name};

use super::starts::{half_open, starts};
use crate::fit::{Fit, FitError, FitSettings, Prediction, fit_predicted, predict};
use crate::regression::Ground;

/// An effect at a place.
#[derive(Debug, Clone)]
pub struct Addition {
    /// The effect.
    pub physics: AnyEffect,
    /// Where.
    pub site: Site,
}

impl PartialEq for Addition {
    fn eq(&self, other: &Self) -> bool {
        self.physics.card().name == other.physics.card().name && self.site == other.site
    }
}

impl Addition {
    /// `effect@place` on the machine of `model`.
    pub fn name(&self, model: &Model) -> String {
        addition_name(&self.physics.card().name, site_name(&model.machine, self.site))
    }
}

/// Every candidate effect, and every loss of the given model, at every place of the machine where it can act, is not
/// present yet, and could show in these recordings.
pub fn additions(model: &Model, recordings: &[&Recording]) -> Vec<Addition> {
    let warms_up = warming(recordings) >= LEAST_WARMING;
    let shows = |one: &Addition| warms_up || one.physics.formula().is_some() || !one.physics.reads_temperature();
    of_families(model, Family::is_candidate).into_iter().filter(shows).collect()
}

/// Least range of the oil temperature over all recordings for which its laws are tried, K: a viscosity changes over it by an
/// eighth, and at less a law of the temperature is only another coefficient.
const LEAST_WARMING: f64 = 3.0;

/// Range of the oil temperature over all recordings, K; nothing where none has it.
fn warming(recordings: &[&Recording]) -> f64 {
    let values = || recordings.iter().flat_map(|one| one.oil_temperature.iter().copied()).filter(|one| one.is_finite());
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

/// Every structural effect at every place where it can act and is not present yet.
pub(super) fn structural_additions(model: &Model) -> Vec<Addition> {
    of_families(model, |family| family == Family::Construction)
}

fn of_families(model: &Model, wanted: impl Fn(Family) -> bool) -> Vec<Addition> {
    let wanted = model.catalogue.iter().filter(|effect| wanted(effect.card().family));
    wanted
        .flat_map(|physics| {
            let sites = model.free_sites(physics).into_iter();
            sites.map(move |site| Addition { physics: physics.clone(), site })
        })
        .collect()
}

/// Why an addition could not be fitted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdditionError {
    /// The effect does not fit the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// It could not be fitted.
    #[error(transparent)]
    Fit(#[from] FitError),
}

/// Fits `model` with one more effect, from the most promising start.
///
/// # Errors
/// [`AdditionError`].
pub(crate) fn fit_addition(
    model: &Model,
    addition: &Addition,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, AdditionError> {
    let start = best_start(model, addition, recordings, None, settings)?;
    Ok(fit_predicted(&start.model, start.promise, recordings, settings)?)
}

/// Where the fit of an addition starts.
pub(super) struct PromisingStart {
    /// The model with the effect, at the start.
    pub model: Model,
    /// Prediction of one step from there.
    pub promise: Prediction,
}

/// The start of an addition whose first step is predicted to reach the lowest loss. `ground` holds the recordings as
/// seen by the model without the addition, if known.
///
/// # Errors
/// [`AdditionError`].
pub(super) fn best_start(
    model: &Model,
    addition: &Addition,
    recordings: &[&Recording],
    ground: Option<&Ground>,
    settings: &FitSettings,
) -> Result<PromisingStart, AdditionError> {
    let extended = model.with_effect(&addition.physics, addition.site)?;
    most_promising(starts(&extended, recordings, ground), recordings, settings)
}

/// Selects, from some starts of one addition and from those with its other possible windows, the one whose first step
/// is predicted to reach the lowest loss.
///
/// # Errors
/// [`AdditionError`].
pub(super) fn most_promising(
    starts: Vec<Model>,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<PromisingStart, AdditionError> {
    let mut best: Option<PromisingStart> = None;
    let mut failure = None;
    let mut try_one = |start: Model, best: &mut Option<PromisingStart>| match predict(&start, recordings, settings) {
        Ok(promise) if best.as_ref().is_none_or(|best| promise.loss_after < best.promise.loss_after) => {
            *best = Some(PromisingStart { model: start, promise });
        }
        Ok(_) => {}
        Err(error) => failure = Some(error),
    };
    for start in starts {
        try_one(start, &mut best);
    }
    let half_open = best.as_ref().map_or_else(Vec::new, |best| half_open(&best.model));
    for start in half_open {
        try_one(start, &mut best);
    }
    match (best, failure) {
        (Some(best), _) => Ok(best),
        (None, Some(error)) => Err(error.into()),
        (None, None) => Err(FitError::NoActiveWindow.into()),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    #[test]
    fn a_structural_effect_is_no_candidate() {
        let model = built_in("zx30u-arm").unwrap();
        let additions = additions(&model, &[]);
        let tries = |name: &str| additions.iter().any(|addition| addition.physics.card().name == name);
        assert!(tries("valve_dead_zone") && !tries("pressure_compensation"));
        assert!(structural_additions(&model).iter().any(|one| one.physics.card().name == "pressure_compensation"));
        assert_eq!(model.parse_addition("pressure_compensation@arm").unwrap().len(), 1);
    }

    #[test]
    fn laws_of_the_temperature_are_tried_where_the_oil_warms_up() {
        let model = built_in("zx30u-arm").unwrap();
        let mut recording = Recording::unmeasured("warming", vec![0.0, 1.0], &["arm"]);
        let reads = |one: &Addition| one.physics.reads_temperature();
        assert!(!additions(&model, &[&recording]).iter().any(reads), "no temperature");
        recording.oil_temperature = vec![40.0, 41.0];
        assert!(!additions(&model, &[&recording]).iter().any(reads), "warm oil");
        recording.oil_temperature = vec![20.0, 41.0];
        let found: Vec<String> =
            additions(&model, &[&recording]).iter().filter(|one| reads(one)).map(|one| one.name(&model)).collect();
        let expected = [
            "viscosity_temperature@arm",
            "seal_friction_temperature@arm",
            "bulk_modulus_temperature@arm",
            "bulk_modulus_temperature@pump",
        ];
        assert_eq!(found, expected);
    }
}
