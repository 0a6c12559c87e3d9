//! Effects that are fitted along where recordings show them, and never named as missing: how the recordings were made, and how
//! widely a corner of the equations is rounded.

use std::cell::Cell;
use std::ops::ControlFlow;

use excavator_model::effects::{ActsOn, CATALOGUE, Effect, Family, Site, Start};
use excavator_model::recording::{Recording, is_measured};
use excavator_model::{Model, ModelEffect, Parameter};

use crate::fit::{Fit, FitError, FitSettings, Watch, fit_watched};

/// Families of these effects that a regression can estimate. Smoothed velocities turn round slower than the piston.
pub const IN_REGRESSION: &[Family] = &[Family::Recording];

/// Those that a fit of simulated outputs can.
const IN_FITS: &[Family] = &[Family::Recording, Family::Rounding];

/// Standard errors by which such an effect must differ from nothing. A model without it is the simpler one.
const LEAST_SIGNIFICANCE: f64 = 3.0;

/// Most that instruments are read apart, as a part of the sample interval: an opening that is held between samples comes
/// to half. More is no matter of recordings: a valve lags or sensors delay, and candidates are tried for that.
const MOST_OF_A_SAMPLE: f64 = 0.65;

/// Or this, s, where recordings are fast: a controller's cycle of a millisecond, and a little. Nobody orders a valve for that.
const MOST_AT_ONCE: f64 = 1.3e-3;

/// And this, s, where the spool's sensor is late: it has a filter, and no candidate could be taken for that.
const MOST_BEHIND: f64 = 5e-3;

/// Most that a spool sensor's zero is off, as a part of the largest opening: the accuracy of an ordinary transducer.
const MOST_OF_THE_OPENING: f64 = 5e-3;

/// Speeds (m/s) over which friction can turn round and be no more than rounded otherwise. Sharper ones nobody can see; of more than
/// 6 mm/s, as seals have them at their slowest, it is a friction with a shape of its own.
const REVERSAL_SPEEDS: std::ops::RangeInclusive<f64> = 2e-4..=6e-3;

/// Shapes of the corner that friction turns: from one that is softer than `x / sqrt(1 + x²)`, at minus one, to the straightest there
/// is. Softer ones would be friction that grows at working speeds. From about 12 no fit can tell how straight: a limit short of the
/// straightest took a corner of 15.0 away, and a loss of 0.3 came back.
const CORNERS: std::ops::RangeInclusive<f64> = -2.0..=20.0;

/// Pressure drops (Pa) at which the flow through a valve can turn turbulent: a slot of 0.1 mm in cold oil reaches 3 bar.
const TRANSITIONS: std::ops::RangeInclusive<f64> = 2e2..=3e5;

/// Part of a convention by which a machine must differ from it, or nobody can tell the two apart.
const LEAST_DIFFERENCE: f64 = 0.1;

/// What `estimate` makes of a model with those effects of the `families` that `recordings` show; `plain` is what it made of the model
/// without them, and is returned where they show none or nothing can be made of them. They are put `behind` so many effects
/// of the model, so that a candidate stays its last. `model_of` is the model in a result, with standard errors; `is_all` tells
/// whether nothing is left that something else could explain.
pub fn with_effects_along<R>(
    plain: R,
    families: &[Family],
    behind: usize,
    recordings: &[&Recording],
    model_of: impl Fn(&R) -> &Model,
    estimate: impl Fn(&Model) -> Option<R>,
    is_all: impl Fn(&R) -> bool,
) -> R {
    let mut added = shown_by(model_of(&plain), families, recordings);
    while !added.is_empty() {
        let mut model = model_of(&plain).clone();
        let effects = added.iter().filter_map(|&(physics, site)| ModelEffect::new(physics, &model.machine, site).ok());
        let effects: Vec<ModelEffect> = effects.collect();
        model.effects.splice(behind..behind, effects);
        let Some(extended) = estimate(&model) else { break };
        let before = added.len();
        let unseen: Vec<_> = added
            .iter()
            .copied()
            .filter(|&(physics, site)| !is_seen(model_of(&extended), physics, site, recordings))
            .collect();
        added.retain(|&addition| !is_among(&first_to_go(&unseen), addition));
        if added.len() == before {
            if is_all(&extended) || !added.iter().any(|(physics, _)| looks_like_more(*physics)) {
                return extended;
            }
            added.retain(|(physics, _)| !looks_like_more(*physics));
        }
    }
    plain
}

/// Of the effects that cannot be seen together those that are left out before the others are asked again: a speed of reversal and
/// the corner that goes with it change the same few readings, so either may hide the other.
fn first_to_go(unseen: &[(&'static dyn Effect, Site)]) -> Vec<(&'static dyn Effect, Site)> {
    let is = |addition: &(&'static dyn Effect, Site), name: &str| addition.0.card().name == name;
    let has_corner = |site: Site| unseen.iter().any(|other| other.1 == site && is(other, "friction_corner"));
    let waits = |addition: &(&'static dyn Effect, Site)| is(addition, "friction_reversal") && has_corner(addition.1);
    unseen.iter().copied().filter(|addition| !waits(addition)).collect()
}

fn is_among(additions: &[(&'static dyn Effect, Site)], (physics, site): (&'static dyn Effect, Site)) -> bool {
    additions.iter().any(|(other, place)| other.card().name == physics.card().name && *place == site)
}

/// Whether what a valve lacks looks much like the effect: a play shifts the opening by half of itself, most of the time to one side.
/// Fitted along where something is missing, a shifted zero would take half of that away and hide it.
fn looks_like_more(physics: &dyn Effect) -> bool {
    physics.card().name == "spool_sensor_offset"
}

/// Typical loss of a fit up to which nothing is left but noise, as for [`crate::diagnosis::DiagnosisSettings::adequate_loss`].
const NOISE: f64 = 0.2;

/// A fit of simulated outputs ([`crate::fit::fit`]), with those effects along that the recordings show. `watch` is told before each
/// step and may end the fit.
///
/// # Errors
/// [`FitError`]; not [`FitError::Stopped`] where the fit without them was done already.
pub fn fit_with_effects_along(
    model: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
    watch: Watch<'_>,
) -> Result<Fit, FitError> {
    let plain = fit_watched(model, recordings, settings, &|done| watch(0.5 * done))?;
    // There may be more than one fit with them; what is done never becomes less.
    let furthest = Cell::new(0.5_f64);
    let onward = |done: f64| {
        furthest.set(furthest.get().max(0.5 + 0.5 * done));
        watch(furthest.get())
    };
    Ok(refitted(plain, model.effects.len(), recordings, settings, &onward))
}

/// [`with_effects_along`] of a fit, by the same fit.
pub(crate) fn refitted_with_effects_along(
    fitted: Fit,
    behind: usize,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Fit {
    refitted(fitted, behind, recordings, settings, &|_| ControlFlow::Continue(()))
}

/// Effects of `fitted` that were fitted along, since `given` has them not: with their places, in the order of `fitted`.
pub fn found_along<'a>(given: &'a Model, fitted: &'a Model) -> impl Iterator<Item = &'a ModelEffect> {
    fitted
        .effects
        .iter()
        .filter(|effect| IN_FITS.contains(&effect.physics.card().family) && !given.has(effect.name(), effect.site))
}

fn refitted(fitted: Fit, behind: usize, recordings: &[&Recording], settings: &FitSettings, watch: Watch<'_>) -> Fit {
    let anew = |model: &Model| fit_watched(model, recordings, settings, watch).ok();
    let is_all = |fitted: &Fit| fitted.typical_loss() <= NOISE;
    with_effects_along(fitted, IN_FITS, behind, recordings, |fitted| &fitted.model, anew, is_all)
}

/// Effects of the `families` that the model has not and that `recordings` can show.
fn shown_by(model: &Model, families: &[Family], recordings: &[&Recording]) -> Vec<(&'static dyn Effect, Site)> {
    // Only a measured opening can be read at another time than the rest; a command acts when it is given.
    let measures_spool = |site: &Site| match *site {
        Site::Cylinder(index) => recordings.iter().all(|recording| {
            let name = &model.machine.cylinders[index].name;
            recording.cylinder(name).is_ok_and(|signals| is_measured(&signals.orifice_area))
        }),
        Site::PumpLine | Site::Machine => false,
    };
    CATALOGUE
        .iter()
        .copied()
        .filter(|physics| families.contains(&physics.card().family))
        .flat_map(|physics| model.free_sites(physics).into_iter().map(move |site| (physics, site)))
        .filter(|(physics, site)| match physics.card().family {
            Family::Rounding => rounds_something(*physics, *site, model),
            _ => measures_spool(site),
        })
        .collect()
}

/// Effects that friction of a piston is made of.
const FRICTIONS: [&str; 4] =
    ["coulomb_friction", "stribeck_friction", "pressure_dependent_friction", "asymmetric_friction"];

/// Whether the model has what an effect rounds: a friction of zero has no corner, and shows none.
fn rounds_something(physics: &dyn Effect, site: Site, model: &Model) -> bool {
    if physics.card().acts_on == ActsOn::Valve {
        return model.has("orifice_flow", site);
    }
    let frictions = FRICTIONS.iter().filter_map(|name| model.effect(name, site));
    frictions.flat_map(|friction| friction.parameters.first()).any(|level| level.value > 0.0)
}

/// Whether all parameters of an effect that was fitted along still differ from nothing. It may have stood in for what was missing.
pub fn still_shows(effect: &ModelEffect) -> bool {
    effect.parameters.iter().all(differs)
}

/// By more than its own uncertainty, and enough for anybody to tell.
fn differs(parameter: &Parameter) -> bool {
    let least = LEAST_SIGNIFICANCE * parameter.standard_error.unwrap_or(f64::INFINITY);
    // A shift or a lead starts from zero, of which any part is none.
    (parameter.value - nothing(parameter)).abs() >= least.max(LEAST_DIFFERENCE * nothing(parameter))
}

/// Whether all parameters of an effect differ from nothing, and by no more than recordings are off or corners are rounded.
fn is_seen(model: &Model, physics: &dyn Effect, site: Site, recordings: &[&Recording]) -> bool {
    model.effect(physics.card().name, site).is_some_and(|effect| {
        effect.parameters.iter().all(|parameter| {
            let is_plausible = match parameter.card.unit {
                "s" if parameter.value < 0.0 => -parameter.value <= latest(recordings).max(MOST_BEHIND),
                "s" => parameter.value <= latest(recordings),
                "m/s" => REVERSAL_SPEEDS.contains(&parameter.value),
                "-" => CORNERS.contains(&parameter.value),
                "Pa" => TRANSITIONS.contains(&parameter.value),
                _ => parameter.value.abs() <= largest_zero(model, site, recordings),
            };
            is_plausible && differs(parameter)
        })
    })
}

/// Value of a parameter with which its effect changes nothing: that from which it is searched.
fn nothing(parameter: &Parameter) -> f64 {
    match parameter.card.start {
        Start::At([start, ..]) => *start,
        _ => 0.0,
    }
}

/// Most that instruments are read apart, s.
fn latest(recordings: &[&Recording]) -> f64 {
    let interval = recordings.iter().map(|recording| recording.sample_interval()).fold(0.0, f64::max);
    (MOST_OF_A_SAMPLE * interval).max(MOST_AT_ONCE)
}

/// Most that the zero of the spool sensor at `site` is off, m².
fn largest_zero(model: &Model, site: Site, recordings: &[&Recording]) -> f64 {
    let Site::Cylinder(index) = site else { return 0.0 };
    let name = &model.machine.cylinders[index].name;
    let openings = recordings.iter().filter_map(|recording| recording.cylinder(name).ok());
    let areas = openings.flat_map(|signals| &signals.orifice_area).filter(|area| area.is_finite());
    MOST_OF_THE_OPENING * areas.fold(0.0, |largest: f64, area| largest.max(area.abs()))
}
