//! Selects manoeuvres and their order.

use rayon::prelude::*;

use excavator_model::recording::Recording;

use super::plan::{Plan, RATE, Refusal};
use super::ride::Rider;
use super::{DesignError, DesignSettings, Manoeuvre, Violation};

/// A manoeuvre that stays inside the limits for every rival.
pub(super) struct Screened {
    pub manoeuvre: Manoeuvre,
    /// Noise-free readings of each rival's instruments, from rest at the manoeuvre's place.
    pub recordings: Vec<Recording>,
}

/// How often one manoeuvre may be in a profile. Repeating the best is useful, but its expected benefit depends on the rivals'
/// current parameters, and other manoeuvres hedge against errors in them.
const MOST_REPEATS: usize = 2;
/// Estimated time of a transfer to a manoeuvre, s.
const WAY: f64 = 1.0;
/// Time reserved for the transfer back to mid-stroke, s.
const WAY_BACK: f64 = 4.0;
/// Shortest profile, s, that has room for a manoeuvre for the base parameters.
const ROOM_FOR_GENERAL: f64 = 30.0;

/// Runs every manoeuvre with every rival, from rest at its place.
///
/// # Errors
/// [`DesignError::OutsideLimits`] if none remains.
pub(super) fn screen(
    manoeuvres: Vec<Manoeuvre>,
    riders: &[Rider<'_>],
    settings: &DesignSettings,
) -> Result<Vec<Screened>, DesignError> {
    let tried = manoeuvres.len();
    let outcomes: Vec<Result<Screened, Violation>> =
        manoeuvres.into_par_iter().map(|manoeuvre| survive(manoeuvre, riders, settings)).collect();
    let mut last = None;
    let mut screened = Vec::new();
    for outcome in outcomes {
        match outcome {
            Ok(one) => screened.push(one),
            Err(violation) => last = Some(violation),
        }
    }
    match (screened.is_empty(), last) {
        (true, Some(violation)) => Err(DesignError::OutsideLimits { tried, violation }),
        _ => Ok(screened),
    }
}

fn survive(manoeuvre: Manoeuvre, riders: &[Rider<'_>], settings: &DesignSettings) -> Result<Screened, Violation> {
    let mut recordings = Vec::with_capacity(riders.len());
    for rider in riders {
        let machine = &rider.system.model().machine;
        let mut places = vec![0.0; machine.cylinders.len()];
        let stroke = machine.cylinders[manoeuvre.cylinder].stroke;
        places[manoeuvre.cylinder] = manoeuvre.place * settings.limits.half_way(stroke);
        let failed = |error: DesignError| Violation::Simulation(error.to_string());
        let start = rider.at_rest(&places).map_err(|error| failed(error.into()))?;
        let mut ride = rider.run(manoeuvre.cylinder, &manoeuvre.segments, start, 0.0, RATE).map_err(failed)?;
        settings.limits.check(machine, &ride.extremes)?;
        settings.sensors.hide_unmeasured(machine, rider.system.layout(), &mut ride.recording);
        recordings.push(ride.recording);
    }
    Ok(Screened { manoeuvre, recordings })
}

/// Joins manoeuvres into a plan of at most the duration asked for. Each step adds the one that raises `score` most per second
/// among those that stay inside the limits from the rivals' current states. `score` takes the indices of the manoeuvres in the
/// plan; `general` is the index of the one that determines the base parameters.
///
/// # Errors
/// [`DesignError::OutsideLimits`] if no manoeuvre can be joined.
pub(super) fn join(
    screened: &[Screened],
    general: Option<usize>,
    cylinders: &[usize],
    riders: &[Rider<'_>],
    settings: &DesignSettings,
    score: &(dyn Fn(&[usize]) -> f64 + Sync),
) -> Result<Plan, DesignError> {
    let limits = &settings.limits;
    let mut plan = Plan::empty(riders)?;
    let mut chosen: Vec<usize> = Vec::new();
    let mut violation = None;
    if let Some(general) = general.filter(|_| settings.duration >= ROOM_FOR_GENERAL)
        && let Ok(longer) = plan.with(&screened[general].manoeuvre, riders, limits, settings.duration)?
    {
        plan = longer;
        chosen.push(general);
    }
    loop {
        let now = if chosen.is_empty() { 0.0 } else { score(&chosen) };
        let mut ranking: Vec<(f64, usize)> = (0..screened.len())
            .into_par_iter()
            .filter(|index| chosen.iter().filter(|other| *other == index).count() < MOST_REPEATS)
            .map(|index| {
                let with = [chosen.as_slice(), &[index]].concat();
                ((score(&with) - now) / (screened[index].manoeuvre.duration() + WAY), index)
            })
            .collect();
        ranking.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut longer = None;
        for &(gain, index) in &ranking {
            if gain.is_nan() || gain <= 0.0 {
                break;
            }
            match plan.with(&screened[index].manoeuvre, riders, limits, settings.duration - WAY_BACK)? {
                // A plan that cannot return to its start cannot be run again.
                Ok(next) => match next.brought_back(cylinders, riders, limits)? {
                    Ok(_) => {
                        longer = Some((next, index));
                        break;
                    }
                    Err(Refusal::Limit(what)) => violation = Some(what),
                    Err(Refusal::TooLong) => {}
                },
                Err(Refusal::Limit(what)) => violation = Some(what),
                Err(Refusal::TooLong) => {}
            }
        }
        let Some((next, index)) = longer else { break };
        plan = next;
        chosen.push(index);
    }
    if plan.moves.is_empty()
        && let Some(violation) = violation
    {
        return Err(DesignError::OutsideLimits { tried: screened.len(), violation });
    }
    Ok(match plan.brought_back(cylinders, riders, limits)? {
        Ok(back) => back,
        Err(_) => plan,
    })
}
