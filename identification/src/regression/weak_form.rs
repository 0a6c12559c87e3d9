//! Weak-form regression with instruments from the simulated model.
//!
//! Each equation is multiplied by test functions and integrated by parts, so that no measurement is differentiated
//! (conservation form for chambers). Residuals are linearised in the parameters, which is exact for linear coefficients
//! and a Gauss-Newton step for shape parameters. Instruments are the same regressors on the simulated state, whose
//! errors are independent of sensor noise, so that noise in regressors does not bias the result
//! (`docs/how-it-works.md`).

use std::ops::ControlFlow;

use excavator_model::Model;
use excavator_model::effects::Family;
use excavator_model::recording::Recording;

use super::seen::{Ground, Seen};
use super::weak_rows::rows;
use super::weak_solution::solve;
use super::{Regression, RegressionError, WeakFormSettings};
use crate::fit::{FitError, Watch};

/// The first round with instruments of a model that was fitted to these recordings. All later rounds also remove noise
/// relative to its simulation. A model that is fitted repeatedly to signals smoothed relative to itself fits its own
/// noise: with three rounds 91 % of the 95 % intervals of a pump line's bulk modulus contained the truth, with six 90
/// %. Now it is 97 %, which is nearer to 95 %.
const FIRST_WITH_INSTRUMENTS: usize = 1;

/// Identifies the unknown parameters of `model` from `recordings`, starting from its values.
///
/// ```
/// use excavator_identification::prelude::*;
/// use excavator_model::prelude::*;
///
/// let machine = built_in("zx30u-arm")?;
/// # let time: Vec<f64> = (0..8000).map(|sample| f64::from(sample) * 2e-3).collect();
/// # let mut command = Recording::unmeasured("swing", time, &["arm"]);
/// # command.tank_pressure.fill(3e5);
/// # let area = |t: &f64| 5e-5 * (3.1 * t).sin() + 3e-5 * (7.3 * t).sin();
/// # command.cylinders[0].orifice_area = command.time.iter().map(area).collect();
/// let recording = simulate_from_rest(&machine, &command, &[0.1], Tolerances::default().scaled(0.05))?;
/// // A model whose numbers are a tenth too large.
/// let mut given = machine.clone();
/// given.parameters_mut().filter(|parameter| !parameter.known).for_each(|parameter| parameter.value *= 1.1);
///
/// let found = weak_form(&given, &[&recording], &WeakFormSettings::default())?;
/// let gain = found.model.value_of("arm.flow_gain_cap").ok_or("no such parameter")?;
/// assert!((gain / 4.6e-3 - 1.0).abs() < 0.02, "{gain} m/(s sqrt(Pa))");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RegressionError`].
pub fn weak_form(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
) -> Result<Regression, RegressionError> {
    weak_form_watched(model, recordings, settings, &|_| ControlFlow::Continue(()))
}

/// Like [`weak_form`], but calls `watch` before each round and stops when it returns a break.
///
/// # Errors
/// [`RegressionError`], with [`FitError::Stopped`] in it if `watch` stopped it.
pub fn weak_form_watched(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    watch: Watch<'_>,
) -> Result<Regression, RegressionError> {
    identified(model, recordings, settings, None, watch)
}

/// Like [`weak_form`], but the first round uses the data in `ground`.
///
/// # Errors
/// [`RegressionError`].
pub(crate) fn weak_form_on(
    ground: &Ground,
    model: &Model,
    settings: &WeakFormSettings,
) -> Result<Regression, RegressionError> {
    let recordings: Vec<&Recording> = ground.recordings.iter().collect();
    identified(model, &recordings, settings, Some(&ground.seen), &|_| ControlFlow::Continue(()))
}

fn identified(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    first_seen: Option<&[Seen]>,
    watch: Watch<'_>,
) -> Result<Regression, RegressionError> {
    // A smoothed velocity reverses more slowly than its piston, so the rounding of corners is held.
    let families: Vec<Family> =
        model.parameters().map(|(effect, _)| model.effects[effect].physics.card().family).collect();
    let is_rounding = |index: &usize| families[*index] == Family::Rounding;
    let (rounding, mut unknown): (Vec<usize>, Vec<usize>) =
        model.unknown_parameters().into_iter().partition(is_rounding);
    let mut held: Vec<(usize, String)> =
        rounding.into_iter().map(|index| (index, "only fits of simulated outputs show it".to_string())).collect();
    let given = model;
    let mut model = model.clone();
    let rounds = settings.rounds.max(1);
    let mut round = 0;
    let mut guides: Option<Vec<Recording>> = None;
    loop {
        if watch(round as f64 / rounds as f64).is_break() {
            return Err(FitError::Stopped.into());
        }
        let last = round + 1 >= rounds;
        let found;
        let seen = match first_seen.filter(|_| round == 0) {
            Some(seen) => seen,
            None => {
                let guide = |number: usize| guides.as_ref().and_then(|guides| guides.get(number));
                let each = recordings.iter().enumerate();
                let each = each.map(|(number, recording)| Seen::of(&model, recording, guide(number)));
                found = each.collect::<Result<Vec<Seen>, RegressionError>>()?;
                &found
            }
        };
        let rows = rows(&model, recordings, settings, &unknown, round >= FIRST_WITH_INSTRUMENTS, seen)?;
        if round == FIRST_WITH_INSTRUMENTS {
            guides = Some(seen.iter().map(|seen| seen.simulation.recording.clone()).collect());
        }
        let mut solution = match solve(&model, recordings, settings, &unknown, &rows, last && settings.with_errors) {
            Ok(solution) => solution,
            Err(RegressionError::NotIdentifiable { source_name, names }) => {
                let Some(one) = one_of(&model, &names, &mut unknown).filter(|_| settings.hold_at_bounds) else {
                    return Err(RegressionError::NotIdentifiable { source_name, names });
                };
                held.push(one);
                continue;
            }
            Err(error) => return Err(error),
        };
        if !last {
            model = solution.model;
            round += 1;
            continue;
        }
        let outside = if settings.hold_at_bounds { outside(given, &solution) } else { Vec::new() };
        if outside.is_empty() || outside.len() == unknown.len() {
            solution.not_identified.extend(held);
            return Ok(solution);
        }
        model = solution.model;
        let mut values = model.parameter_values();
        unknown.retain(|index| !outside.iter().any(|(other, ..)| other == index));
        for (index, bound, reason) in outside {
            values[index] = bound;
            held.push((index, reason));
        }
        model.set_parameter_values(&values);
        for (index, parameter) in model.parameters_mut().enumerate() {
            if held.iter().any(|(other, _)| *other == index) {
                parameter.standard_error = None;
                parameter.margin_95 = None;
            }
        }
    }
}

/// Removes from `unknown` one of the parameters that show only in combination: the last in the model, which was added
/// to the others. Returns its index and the reason, or `None` if there are no others.
fn one_of(model: &Model, names: &[String], unknown: &mut Vec<usize>) -> Option<(usize, String)> {
    let all = model.parameter_names();
    let held = unknown.iter().copied().filter(|&index| names.len() > 1 && names.contains(&all[index])).max()?;
    unknown.retain(|&index| index != held);
    let others: Vec<&str> = names.iter().filter(|name| **name != all[held]).map(String::as_str).collect();
    let value = model.parameter_values()[held];
    let reason = format!(
        "the equations have it together with {} only, never alone; held at {value:.3e}, and what the others come to holds for \
         that value",
        others.join(", ")
    );
    Some((held, reason))
}

/// Identified parameters that reached the end of their possible range, with the value at which they are held and the reason. An inertia
/// or a bulk modulus is held at its given value, which is known roughly; any other parameter at the nearest possible value.
fn outside(given: &Model, solution: &Regression) -> Vec<(usize, f64, String)> {
    let before = given.parameter_values();
    solution
        .model
        .parameters()
        .enumerate()
        .filter(|(index, _)| solution.fitted.contains(index))
        .filter_map(|(index, (_, parameter))| {
            let card = &parameter.card;
            let bound = parameter.value.clamp(card.minimum, card.maximum);
            if parameter.has_limits_around_given() && (bound <= card.minimum || bound >= card.maximum) {
                let reason = format!(
                    "the recordings do not show it within {:.3e} to {:.3e}; held at the given {:.3e}. Accelerate more, or give a \
                     better value",
                    card.minimum, card.maximum, before[index]
                );
                return Some((index, before[index], reason));
            }
            let reason = format!(
                "the recordings would have it at {:.3e}, beyond what is possible; held at {bound:.3e}. Something that the \
                 model lacks acts in its place, or the recordings do not show it",
                parameter.value
            );
            (bound != parameter.value).then_some((index, bound, reason))
        })
        .collect()
}
