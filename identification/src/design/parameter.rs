//! Designs a profile that determines a parameter.

use excavator_model::Model;
use excavator_model::effects::{Text, nearest};
use excavator_model::simulation::Profile;
use nalgebra::DMatrix;
use rayon::prelude::*;

use super::manoeuvre::general;
use super::ride::Rider;
use super::rival::cylinders;
use super::selection::{Screened, join, screen};
use super::separation::{moderate_sines, noise_free};
use super::trial_run::record;
use super::{DesignError, DesignSettings, Plan, Rival, library};
use crate::fit::{FitSettings, LinearRefit, fit, scales};

/// A proposed profile and how well it would determine a parameter.
#[derive(Debug, Clone)]
pub struct ParameterDesign {
    /// Contract name of the parameter.
    pub name: String,
    /// SI unit.
    pub unit: Text,
    /// Its value in the model.
    pub value: f64,
    /// Its standard error in the model, if it was identified before.
    pub given_error: Option<f64>,
    /// Standard error from moderate sines of the profile's length, from sensor noise alone.
    pub sine_error: f64,
    /// Standard error from the profile, from sensor noise alone.
    pub expected_error: f64,
    /// Standard error that the fit to a trial run with noisy sensors reports.
    pub trial_run_error: f64,
    /// Value that this fit finds.
    pub trial_run_value: f64,
    /// Whether the parameter is expected to differ significantly from zero: its standard error is below half of it.
    pub determined: bool,
    /// The proposed manoeuvres.
    pub plan: Plan,
    /// The same as commands, one profile per cylinder with a valve.
    pub profiles: Vec<Profile>,
    /// Manoeuvres in the library, and how many of them stay inside the limits.
    pub manoeuvres: (usize, usize),
}

/// Share of the parameter above which its standard error leaves it undetermined.
const LARGEST_SHARE: f64 = 0.5;

/// Proposes a profile that determines the parameter with this contract name (`arm.inertia`). Every parameter has a prior standard
/// error equal to its own size. A direction that no data determines therefore has a finite standard error: that size.
///
/// # Errors
/// [`DesignError`].
pub fn determine(
    model: &Model,
    name: &str,
    settings: &DesignSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<ParameterDesign, DesignError> {
    settings.check()?;
    let (index, position) = find(model, name)?;
    let Some((effect, parameter)) = model.parameters().nth(index) else {
        return Err(DesignError::KnownParameter { name: name.to_string() });
    };
    let machine = &model.machine;
    let wanted = cylinders(model, &[Some(model.effects[effect].site)]);
    let manoeuvres = library(machine, &wanted);
    if manoeuvres.is_empty() {
        return Err(DesignError::NoValve { machine: machine.name.clone() });
    }
    let scale = scales(model, &[index]).first().copied().unwrap_or(1.0);
    let alone = Rival { name: name.to_string(), addition: None, model: model.clone() };
    let riders = [Rider::new(&alone.model)];

    progress("manoeuvres within limits", 0.1);
    let tried = manoeuvres.len();
    let with_general: Vec<_> = wanted.first().and_then(|&cylinder| general(machine, cylinder)).into_iter().collect();
    let screened = screen([with_general, manoeuvres].concat(), &riders, settings)?;
    let is_general = |one: &Screened| one.manoeuvre.name == "moderate sine";
    let within = screened.iter().filter(|one| !is_general(one)).count();
    progress("what they show", 0.2);
    let information =
        |recording| linear(model, recording, settings).map(|part| LinearRefit::information(model, &[&part]));
    let count = model.unknown_parameters().len();
    let parts: Vec<DMatrix<f64>> = screened
        .par_iter()
        .map(|one| one.recordings.first().and_then(information).unwrap_or_else(|| DMatrix::zeros(count, count)))
        .collect();
    let error = |information: DMatrix<f64>| scale * relative_error(information, position);
    let score = |chosen: &[usize]| -> f64 {
        let mut sum = DMatrix::zeros(count, count);
        chosen.iter().for_each(|&index| sum += &parts[index]);
        // Zero for an empty choice, as `join` requires.
        -relative_error(sum, position).ln()
    };
    progress("joining manoeuvres", 0.5);
    let general = screened.iter().position(is_general);
    let plan = join(&screened, general, &wanted, &riders, settings, &score)?;
    let profiles = plan.profiles(machine);

    progress("expected standard error", 0.7);
    let whole = noise_free(&alone, &profiles, settings)?;
    let expected_error = error(information(&whole).unwrap_or_else(|| DMatrix::zeros(count, count)));
    let sines = moderate_sines(model, &wanted);
    let length = sines.iter().map(Profile::duration).fold(0.0, f64::max);
    let sines = noise_free(&alone, &sines, settings)?;
    let share = plan.duration / length;
    let sine_error = error(information(&sines).unwrap_or_else(|| DMatrix::zeros(count, count)) * share);
    progress("trial run", 0.8);
    let [fitted, _] = record(&alone, &profiles, settings, 0)?;
    let trial = fit(model, &[&fitted], &settings.fit)?;
    let (trial_run_value, trial_run_error) = trial
        .model
        .parameters()
        .nth(index)
        .map_or((f64::NAN, f64::NAN), |(_, found)| (found.value, found.standard_error.unwrap_or(f64::INFINITY)));
    Ok(ParameterDesign {
        name: name.to_string(),
        unit: parameter.card.unit.clone(),
        value: parameter.value,
        given_error: parameter.standard_error,
        sine_error,
        expected_error,
        trial_run_error,
        trial_run_value,
        determined: expected_error <= LARGEST_SHARE * scale && trial_run_error <= LARGEST_SHARE * scale,
        plan,
        profiles,
        manoeuvres: (tried, within),
    })
}

fn linear(
    model: &Model,
    recording: &excavator_model::recording::Recording,
    settings: &DesignSettings,
) -> Option<LinearRefit> {
    let fit = FitSettings { sample_rate: f64::INFINITY, ..settings.fit };
    let noise = |instrument: &crate::fit::Instrument| settings.sensors.of(&instrument.name).unwrap_or(instrument.noise);
    LinearRefit::new(model, recording, &fit, &noise).ok()
}

/// Standard error of one parameter in units of its scale, with a prior standard error of one scale for each parameter.
fn relative_error(mut information: DMatrix<f64>, position: usize) -> f64 {
    for index in 0..information.nrows() {
        information[(index, index)] += 1.0;
    }
    information.cholesky().map_or(f64::INFINITY, |factor| factor.inverse()[(position, position)].sqrt())
}

/// Index of a parameter among all, and among the unknown ones.
fn find(model: &Model, name: &str) -> Result<(usize, usize), DesignError> {
    let names = model.parameter_names();
    let unknown = model.unknown_parameters();
    let Some(index) = names.iter().position(|own| own == name) else {
        let known: Vec<&str> = unknown.iter().map(|&index| names[index].as_str()).collect();
        return Err(DesignError::UnknownParameter {
            machine: model.machine.name.clone(),
            name: name.to_string(),
            suggestion: nearest(name, known.iter().copied()),
            known: known.join(", "),
        });
    };
    match unknown.iter().position(|&own| own == index) {
        Some(position) => Ok((index, position)),
        None => Err(DesignError::KnownParameter { name: name.to_string() }),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn what_nothing_shows_is_known_to_its_own_size() {
        assert!((relative_error(DMatrix::zeros(3, 3), 1) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_sum_alone_leaves_each_of_its_parts_open() {
        // Only x0 + x1 is observed, very accurately: either may still be off by 1/sqrt(2) of its size.
        let row = nalgebra::RowDVector::from_vec(vec![1.0, 1.0]);
        let seen = row.transpose() * &row * 1e12;
        assert!((relative_error(seen, 0) - 0.5f64.sqrt()).abs() < 1e-3);
        let apart = DMatrix::from_diagonal(&nalgebra::DVector::from_vec(vec![1e6, 1e6]));
        assert!(relative_error(apart, 0) < 1.1e-3);
    }
}
