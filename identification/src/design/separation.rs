//! Designs a profile that separates rivals.

use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Profile, Segment};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::manoeuvre::general;
use super::ride::Rider;
use super::rival::cylinders;
use super::selection::{Screened, join, screen};
use super::trial_run::{best_fit, record, try_out};
use super::{DesignError, DesignSettings, Plan, Rival, TrialRun, library};
use crate::decision::Policy;
use crate::fit::{FitError, FitSettings, LinearRefit, evaluate, fit};
use crate::nullable::Nullable;

/// What is expected of two rivals under the profile; of both directions, in which either is the truth, the worse one counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PairSeparation {
    /// Name of one rival.
    pub first: String,
    /// Name of the other.
    pub second: String,
    /// Difference of their losses on moderate sines that both were fitted to; `null` where rivals came with fitted values.
    #[serde(rename = "improvement_on_sines")]
    pub improvement_before: Option<f64>,
    /// Distance in standard deviations of sensor noise, after a linearised refit.
    #[serde(with = "Nullable")]
    pub distance: f64,
    /// Fall of the log error ratio that goes with the distance, without noise on the spools.
    #[serde(with = "Nullable")]
    pub linear_improvement: f64,
    /// Fall of the log error ratio from the other to the truth in the trial run.
    #[serde(with = "Nullable")]
    pub expected_improvement: f64,
    /// The same in its own standard errors.
    #[serde(with = "Nullable")]
    pub expected_significance: f64,
    /// Whether a diagnosis would no longer call them tied.
    pub separated: bool,
}

/// A proposed profile and its expected result.
#[derive(Debug, Clone)]
pub struct SeparationDesign {
    /// The rivals, with the parameters used in the comparison.
    pub rivals: Vec<Rival>,
    /// The proposed manoeuvres.
    pub plan: Plan,
    /// The same as commands, one profile per cylinder with a valve.
    pub profiles: Vec<Profile>,
    /// Expectations of every pair.
    pub pairs: Vec<PairSeparation>,
    /// Every trial run, truth by truth.
    pub trial_runs: Vec<TrialRun>,
    /// Manoeuvres in the library, and how many of them stay inside the limits.
    pub manoeuvres: (usize, usize),
}

impl SeparationDesign {
    /// Whether every pair is expected to be separated.
    pub fn all_separated(&self) -> bool {
        self.pairs.iter().all(|pair| pair.separated)
    }

    /// Whether at least one pair is expected to be separated.
    pub fn any_separated(&self) -> bool {
        self.pairs.iter().any(|pair| pair.separated)
    }
}

/// Proposes a profile that separates `rivals`. `fitted` means that they have the values of a fit to recordings on which they are
/// tied. Otherwise the others are first fitted to the first one's motion under moderate sines, so that differences which a refit
/// removes do not count. `progress` receives the current step and the fraction done.
///
/// # Errors
/// [`DesignError`].
pub fn separate(
    rivals: Vec<Rival>,
    fitted: bool,
    settings: &DesignSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<SeparationDesign, DesignError> {
    settings.check()?;
    let first = match rivals.as_slice() {
        [] | [_] => {
            let rival = rivals.first().map_or("nothing".to_string(), |rival| rival.name.clone());
            return Err(DesignError::Alone { rival });
        }
        [first, ..] => first,
    };
    let machine = first.model.machine.clone();
    let sites: Vec<_> = rivals.iter().map(|rival| rival.addition.as_ref().map(|addition| addition.site)).collect();
    let wanted = cylinders(&first.model, &sites);
    let manoeuvres = library(&machine, &wanted);
    if manoeuvres.is_empty() {
        return Err(DesignError::NoValve { machine: machine.name.clone() });
    }
    let (rivals, before) = if fitted {
        let nothing = vec![None; rivals.len() * rivals.len()];
        (rivals, nothing)
    } else {
        progress("making rivals alike", 0.05);
        made_alike(rivals, &wanted, settings)?
    };

    progress("manoeuvres within limits", 0.2);
    let riders: Vec<Rider<'_>> = rivals.iter().map(|rival| Rider::new(&rival.model)).collect();
    let tried = manoeuvres.len();
    let with_general: Vec<_> = wanted.first().and_then(|&cylinder| general(&machine, cylinder)).into_iter().collect();
    let screened = screen([with_general, manoeuvres].concat(), &riders, settings)?;
    let is_general = |one: &Screened| one.manoeuvre.name == "moderate sine";
    let general = screened.iter().position(is_general);
    progress("refits to all manoeuvres", 0.25);
    let pairs = directions(rivals.len());
    let models: Vec<Model> =
        pairs.par_iter().map(|&(truth, model)| compromise(&rivals[model].model, truth, &screened, settings)).collect();
    progress("differences after refits", 0.4);
    let parts: Vec<Vec<Option<LinearRefit>>> =
        screened.par_iter().map(|one| refits(&models, &one.recordings, settings)).collect();
    let score = |chosen: &[usize]| -> f64 {
        models
            .iter()
            .enumerate()
            .map(|(number, model)| {
                let own: Vec<&LinearRefit> = chosen.iter().filter_map(|&index| parts[index][number].as_ref()).collect();
                let left = LinearRefit::remainder(model, &own);
                (1.0 + left.log_likelihood_ratio()).ln()
            })
            .sum()
    };
    progress("joining manoeuvres", 0.5);
    let plan = join(&screened, general, &wanted, &riders, settings, &score)?;
    let profiles = plan.profiles(&machine);

    progress("expected separation", 0.6);
    let whole = rivals
        .iter()
        .map(|rival| noise_free(rival, &profiles, settings))
        .collect::<Result<Vec<Recording>, DesignError>>()?;
    let refitted = refits(&models, &whole, settings);
    let trial_runs = try_out(&rivals, &profiles, settings, &|what, done| progress(what, 0.65 + 0.35 * done))?;
    let within = screened.iter().filter(|one| !is_general(one)).count();
    let pairs = judged(&rivals, &before, &models, &refitted, &trial_runs);
    Ok(SeparationDesign { pairs, plan, profiles, trial_runs, manoeuvres: (tried, within), rivals })
}

/// Every ordered pair (truth, model) of `count` rivals.
fn directions(count: usize) -> Vec<(usize, usize)> {
    (0..count)
        .flat_map(|truth| (0..count).filter(move |model| *model != truth).map(move |model| (truth, model)))
        .collect()
}

/// Steps of the fit to all manoeuvres.
const COMPROMISE_STEPS: usize = 4;

/// A model fitted to all manoeuvres of a truth at once. From there one linearised step suffices for any choice of manoeuvres. If
/// the fit fails, the model is returned unchanged.
fn compromise(model: &Model, truth: usize, screened: &[Screened], settings: &DesignSettings) -> Model {
    let recordings: Vec<&Recording> = screened.iter().filter_map(|one| one.recordings.get(truth)).collect();
    let few = FitSettings { sample_rate: f64::INFINITY, maximum_steps: COMPROMISE_STEPS, ..settings.fit };
    fit(model, &recordings, &few).map_or_else(|_| model.clone(), |found| found.model)
}

/// For every ordered pair the refit of its model to the truth's recording; `None` if it cannot be simulated. `models` are in the
/// order of `directions`.
fn refits(models: &[Model], recordings: &[Recording], settings: &DesignSettings) -> Vec<Option<LinearRefit>> {
    let all = FitSettings { sample_rate: f64::INFINITY, ..settings.fit };
    directions(recordings.len())
        .into_iter()
        .zip(models)
        .map(|((truth, _), model)| {
            LinearRefit::new(model, &recordings[truth], &all, &|instrument| {
                settings.sensors.of(&instrument.name).unwrap_or(instrument.noise)
            })
            .ok()
        })
        .collect()
}

/// Noise-free readings of a rival's instruments, at the sample rate of the plan.
pub(super) fn noise_free(
    rival: &Rival,
    profiles: &[Profile],
    settings: &DesignSettings,
) -> Result<Recording, DesignError> {
    let rider = Rider::new(&rival.model);
    let machine = &rival.model.machine;
    let start = rider.at_rest(&vec![0.0; machine.cylinders.len()])?;
    let mut ride = rider.run_profiles(profiles, start, 0.0, super::plan::RATE)?;
    settings.sensors.hide_unmeasured(machine, rider.system.layout(), &mut ride.recording);
    Ok(ride.recording)
}

/// Expected separation of every unordered pair.
fn judged(
    rivals: &[Rival],
    before: &[Option<f64>],
    models: &[Model],
    refitted: &[Option<LinearRefit>],
    trial_runs: &[TrialRun],
) -> Vec<PairSeparation> {
    let rules = Policy::default();
    let directed = directions(rivals.len());
    let mut pairs = Vec::new();
    for first in 0..rivals.len() {
        for second in first + 1..rivals.len() {
            let both = [(first, second), (second, first)];
            let (mut distance, mut linear_improvement) = (f64::INFINITY, f64::INFINITY);
            let (mut improvement, mut significance) = (f64::INFINITY, f64::INFINITY);
            for (number, _) in directed.iter().enumerate().filter(|(_, pair)| both.contains(pair)) {
                if let Some(part) = &refitted[number] {
                    let left = LinearRefit::remainder(&models[number], &[part]);
                    distance = distance.min(left.distance());
                    linear_improvement = linear_improvement.min(left.gain());
                }
                // Trial runs are in the order of `directions`.
                improvement = improvement.min(trial_runs[number].improvement);
                significance = significance.min(trial_runs[number].significance);
            }
            pairs.push(PairSeparation {
                first: rivals[first].name.clone(),
                second: rivals[second].name.clone(),
                improvement_before: before[first * rivals.len() + second],
                distance,
                linear_improvement,
                expected_improvement: improvement,
                expected_significance: significance,
                separated: improvement >= rules.least_improvement && significance >= rules.least_significance,
            });
        }
    }
    pairs
}

/// Fits all rivals but the first to the first one's motion under moderate sines. Also returns, row by row, the difference between
/// any two rivals' losses there.
fn made_alike(
    mut rivals: Vec<Rival>,
    cylinders: &[usize],
    settings: &DesignSettings,
) -> Result<(Vec<Rival>, Vec<Option<f64>>), DesignError> {
    let profiles = moderate_sines(&rivals[0].model, cylinders);
    let [fitted, kept] = record(&rivals[0], &profiles, settings, u64::MAX)?;
    let fits =
        rivals[1..].par_iter().map(|rival| best_fit(rival, &fitted, settings)).collect::<Result<Vec<_>, FitError>>()?;
    for (rival, fit) in rivals[1..].iter_mut().zip(fits) {
        rival.model = fit.model;
    }
    let losses = rivals
        .par_iter()
        .map(|rival| Ok(evaluate(&rival.model, &[&kept], &settings.fit)?.loss()))
        .collect::<Result<Vec<f64>, FitError>>()?;
    let differences = losses.iter().flat_map(|a| losses.iter().map(move |b| Some((a - b).abs()))).collect();
    Ok((rivals, differences))
}

/// A recording of the kind that leaves effects tied: two sines of moderate size for each cylinder.
pub(super) fn moderate_sines(model: &Model, cylinders: &[usize]) -> Vec<Profile> {
    let mut plan: Vec<(usize, Segment)> = Vec::new();
    for &cylinder in cylinders {
        let Some(chambers) = model.machine.cylinders.get(cylinder).and_then(|cylinder| cylinder.chambers) else {
            continue;
        };
        for (share, frequency) in [(0.5, 0.5), (0.35, 0.8)] {
            let amplitude = share * chambers.full_command();
            plan.push((cylinder, Segment::Hold { duration: 0.5, area: 0.0 }));
            plan.push((cylinder, Segment::Sine { duration: 6.0, amplitude, frequency }));
        }
    }
    Plan { chosen: Vec::new(), duration: 0.0, moves: plan, states: Vec::new() }.profiles(&model.machine)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

    fn named(names: &[&str]) -> Vec<Rival> {
        let names: Vec<String> = names.iter().map(|name| (*name).to_string()).collect();
        Rival::named(&built_in("zx30u-arm").unwrap(), &names).unwrap()
    }

    fn settings() -> DesignSettings {
        DesignSettings::usual(&built_in("zx30u-arm").unwrap().machine)
    }

    /// Remainder after a refit of the second rival to the first one's noise-free motion under moderate sines.
    fn left(rivals: &[Rival]) -> crate::fit::Remainder {
        let profiles = moderate_sines(&rivals[0].model, &[0]);
        let recordings: Vec<Recording> =
            rivals.iter().map(|rival| noise_free(rival, &profiles, &settings()).unwrap()).collect();
        let models = [rivals[1].model.clone(), rivals[0].model.clone()];
        let refitted = refits(&models, &recordings, &settings());
        let remainder = LinearRefit::remainder(&rivals[1].model, &[refitted[0].as_ref().unwrap()]);
        assert_eq!(remainder.counts.len(), 4, "displacement and three pressures");
        remainder
    }

    #[test]
    fn what_a_refit_takes_away_does_not_count() {
        let mut rivals = named(&["none"]);
        rivals.push(rivals[0].clone());
        let same = left(&rivals).distance();
        // A little more inertia and friction: far from the other model, but a refit can remove the difference.
        let names = ["arm.inertia", "arm.coulomb_friction"];
        let changed: Vec<(String, f64)> =
            names.iter().map(|name| ((*name).to_string(), 1.01 * rivals[0].model.value_of(name).unwrap())).collect();
        rivals[0].set(&changed);
        let refitted = left(&rivals).distance();
        assert!(same < 20.0, "{same}");
        assert!(refitted < 40.0, "{refitted}");
        // The same change, with all parameters fixed.
        rivals[1].model.parameters_mut().for_each(|parameter| parameter.known = true);
        let held = left(&rivals).distance();
        assert!(held > 5.0 * refitted, "{held} {refitted}");
    }

    #[test]
    fn what_a_refit_cannot_take_away_counts() {
        let rivals = named(&["valve_dead_zone@arm", "none"]);
        let left = left(&rivals);
        // Ten times the remainder of a refit with free parameters.
        assert!(left.distance() > 400.0, "{}", left.distance());
        assert!(left.gain() > 1.0, "{}", left.gain());
        assert!(left.log_likelihood_ratio() > 0.0);
    }

    #[test]
    fn one_rival_alone_and_impossible_durations_are_refused() {
        let quiet = |_: &str, _: f64| ();
        let alone = separate(named(&["hose_loss@arm"]), false, &settings(), &quiet).unwrap_err();
        assert_eq!(alone, DesignError::Alone { rival: "hose_loss@arm".into() });
        for duration in [3.0, f64::NAN, 1e6] {
            let settings = DesignSettings { duration, ..settings() };
            let error = separate(named(&["hose_loss", "valve_lag"]), false, &settings, &quiet).unwrap_err();
            assert!(matches!(error, DesignError::Duration { .. }), "{error}");
        }
    }
}
