//! Nuisance effects: properties of the recording, and the rounding of corners in the equations.
//!
//! They are estimated with every model, each with the prior of its card, and are never attributed. A spool sensor that
//! is read half a millisecond early, or friction that reverses over 3 mm/s instead of 1 mm/s, resembles a small amount
//! of many other effects.

use excavator_model::effects::{Corner, Effect, Family, Site};
use excavator_model::machine::Cylinder;
use excavator_model::recording::{Recording, is_measured};
use excavator_model::{Model, ModelEffect, Parameter};

use super::priors::centre;
use super::{Fit, FitError, FitSettings, fit};

/// Whether an effect of this family is a nuisance.
pub fn is_nuisance(family: Family) -> bool {
    matches!(family, Family::Recording | Family::Rounding)
}

/// `model` with every nuisance effect that it lacks and that these recordings can have.
#[must_use]
pub fn with_nuisances(model: &Model, recordings: &[&Recording]) -> Model {
    with_nuisances_of(model, &[Family::Recording, Family::Rounding], recordings)
}

/// The same for these families only. A regression cannot estimate [`Family::Rounding`]: a smoothed velocity reverses
/// more slowly than the piston.
#[must_use]
pub fn with_nuisances_of(model: &Model, families: &[Family], recordings: &[&Recording]) -> Model {
    let mut extended = model.clone();
    for physics in model.catalogue.iter().filter(|physics| families.contains(&physics.card().family)) {
        let sites = model.free_sites(physics).into_iter();
        for site in sites.filter(|site| can_have(model, &**physics, *site, recordings)) {
            extended.effects.extend(ModelEffect::new(physics, &model.machine, site));
        }
    }
    extended
}

/// Whether the piston of this cylinder reaches one of its ends.
fn comes_to_an_end(cylinder: &Cylinder, recordings: &[&Recording]) -> bool {
    let signals = recordings.iter().filter_map(|recording| recording.cylinder(&cylinder.name).ok());
    signals.flat_map(|signals| &signals.displacement).any(|displacement| cylinder.is_at_an_end(*displacement))
}

/// Only a measured opening can have a different sampling time or zero than the other signals. A command acts when it is
/// given.
fn can_have(model: &Model, physics: &dyn Effect, site: Site, recordings: &[&Recording]) -> bool {
    match site {
        Site::Cylinder(index) if physics.rounds() == Some(Corner::EndStop) => {
            comes_to_an_end(&model.machine.cylinders[index], recordings) && model.has_corner(Corner::EndStop, site)
        }
        Site::Cylinder(index) if physics.card().family == Family::Recording => {
            let name = &model.machine.cylinders[index].name;
            recordings.iter().all(|one| one.cylinder(name).is_ok_and(|signals| is_measured(&signals.orifice_area)))
        }
        _ => true,
    }
}

/// Nuisance effects of `fitted` that `given` lacks and that differ from their neutral value, in the order of `fitted`.
pub fn nuisances_shown<'a>(given: &'a Model, fitted: &'a Model) -> impl Iterator<Item = &'a ModelEffect> {
    fitted.effects.iter().filter(|effect| is_added(given, effect) && effect.parameters.iter().any(differs))
}

/// A model without the nuisance effects that `given` lacks and that do not differ from their neutral value.
#[derive(Debug, Clone)]
#[must_use]
pub struct Simplified {
    /// The model.
    pub model: Model,
    /// Indices of its parameters in the original model.
    kept: Vec<usize>,
}

impl Simplified {
    /// Simplifies a fitted model.
    pub fn of(given: &Model, fitted: &Model) -> Self {
        let is_idle = |effect: &ModelEffect| is_added(given, effect) && !effect.parameters.iter().any(differs);
        let mut model = fitted.clone();
        model.effects.retain(|effect| !is_idle(effect));
        let parameters = fitted.parameters().enumerate();
        let kept = parameters.filter(|(_, (effect, _))| !is_idle(&fitted.effects[*effect])).map(|(index, _)| index);
        Simplified { kept: kept.collect(), model }
    }

    /// Maps the index of a parameter in the original model. Returns `None` if its effect was removed.
    pub fn index(&self, before: usize) -> Option<usize> {
        self.kept.iter().position(|&kept| kept == before)
    }
}

/// A fit without the nuisance effects that `given` lacks and that do not differ from their neutral value. The remaining
/// parameters are fitted again, because the removed effects had biased them.
///
/// # Errors
/// [`FitError`].
pub fn simplified(
    given: &Model,
    fitted: &Fit,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, FitError> {
    let simple = Simplified::of(given, &fitted.model).model;
    if simple.effects.len() == fitted.model.effects.len() {
        return Ok(fitted.clone());
    }
    fit(&simple, recordings, settings)
}

fn is_added(given: &Model, effect: &ModelEffect) -> bool {
    is_nuisance(effect.physics.card().family) && !given.has(effect.name(), effect.site)
}

/// Standard errors by which a nuisance parameter must differ from its neutral value to be reported.
const LEAST_SIGNIFICANCE: f64 = 3.0;

/// Fraction of the neutral value by which it must differ. A tenth more or less is the same convention.
const LEAST_DIFFERENCE: f64 = 0.1;

fn differs(parameter: &Parameter) -> bool {
    let least = LEAST_SIGNIFICANCE * parameter.standard_error.unwrap_or(f64::INFINITY);
    // The neutral value of a shift or a lead is zero, so this fraction of it is zero too.
    (parameter.value - centre(parameter)).abs() >= least.max(LEAST_DIFFERENCE * centre(parameter))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;

    use super::*;

    fn recording(is_spool_measured: bool) -> Recording {
        let time: Vec<f64> = (0..100).map(|index| f64::from(index) * 2e-3).collect();
        let mut recording = Recording::unmeasured("bag", time, &["arm"]);
        if is_spool_measured {
            recording.cylinders[0].orifice_area = vec![1e-5; 100];
        }
        recording
    }

    #[test]
    fn a_spool_that_nobody_measures_has_no_sensor() {
        let given = built_in("zx30u-arm").unwrap();
        let families = |measured| -> Vec<Family> {
            let model = with_nuisances(&given, &[&recording(measured)]);
            model.effects[given.effects.len()..].iter().map(|effect| effect.physics.card().family).collect()
        };
        assert!(families(true).contains(&Family::Recording) && families(true).contains(&Family::Rounding));
        assert!(!families(false).contains(&Family::Recording) && families(false).contains(&Family::Rounding));
        let once = with_nuisances(&given, &[&recording(true)]);
        assert_eq!(with_nuisances(&once, &[&recording(true)]).effects.len(), once.effects.len());
    }

    #[test]
    fn what_does_not_differ_is_left_out_with_its_parameters() {
        let given = built_in("zx30u-arm").unwrap();
        let mut model = with_nuisances(&given, &[&recording(true)]);
        for parameter in model.parameters_mut() {
            parameter.standard_error = Some(1e-9);
        }
        let speed = model.effects.iter_mut().find(|effect| effect.name() == "friction_reversal").unwrap();
        speed.parameters[0].value = 3e-3;
        let simple = Simplified::of(&given, &model);
        let shown: Vec<&str> = nuisances_shown(&given, &model).map(ModelEffect::name).collect();
        assert_eq!(shown, ["friction_reversal"]);
        assert_eq!(simple.model.effects.len(), given.effects.len() + 1);
        let names = simple.model.parameter_names();
        assert_eq!(names.last().unwrap(), "arm.reversal_speed");
        let before = model.parameter_names().iter().position(|name| name == "arm.reversal_speed").unwrap();
        assert_eq!(simple.index(before), Some(names.len() - 1));
    }
}
