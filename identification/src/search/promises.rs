//! Predicts the first step of many additions from one simulation.
//!
//! The outputs respond in proportion to small coefficients of an effect that vanishes at zero coefficients. One
//! simulation with sensitivities to the coefficients of all such effects predicts how far each could lower the error,
//! and with which values. An addition without a predicted improvement needs no simulation of its own.

use excavator_model::effects::Kind;
use excavator_model::equations::{Inputs, Instruments, Reach, System};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelEffect};

use super::Addition;
use super::starts::{plain_starts, within_bounds};
use crate::fit::{FitSettings, Linearised, SegmentedRecording};

/// Prediction for one addition.
pub(super) struct Promised {
    /// Predicted decrease of the loss for the best of its starts.
    pub improvement: f64,
    /// Its starts, the most promising first.
    pub starts: Vec<PromisedStart>,
    /// Whether the linear prediction also holds for large coefficients: the addition acts on its own rows in proportion
    /// to its coefficients, or on the readings of instruments. An effect that shifts an opening may have no predicted
    /// improvement at first, and explain much when it is large.
    pub is_straight: bool,
}

/// A start with its prediction.
pub(super) struct PromisedStart {
    /// The model with the addition.
    pub model: Model,
    /// Predicted loss at this start; see [`crate::fit::Fit::loss`].
    pub loss: f64,
}

/// An effect with its coefficients at zero.
struct Vanished {
    /// The model with it at its start values.
    start: Model,
    effect: ModelEffect,
    /// Indices of its coefficients among its parameters.
    coefficients: Vec<usize>,
    is_straight: bool,
}

/// Predicts the effect of each of the `wanted` additions to `base`. An entry is `None` for an addition that does not
/// vanish at zero coefficients and needs a simulation of its own. The result is `None` if that is true for all, or if
/// the model cannot be simulated on these recordings.
pub(super) fn promises(
    base: &Model,
    wanted: &[Addition],
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Option<Vec<Option<Promised>>> {
    let probes = Probes::of(base, recordings, settings);
    let vanished: Vec<Option<Vec<Vanished>>> = wanted
        .iter()
        .map(|addition| {
            let extended = base.with_effect(&addition.physics, addition.site).ok()?;
            let starts = plain_starts(&extended, recordings).into_iter();
            let vanished: Vec<Vanished> = starts.map(|start| probes.vanished(start)).collect::<Option<_>>()?;
            // Without a window in which the addition may act there is no prediction either.
            (!vanished.is_empty()).then_some(vanished)
        })
        .collect();
    let own = base.unknown_parameters();
    let (mut joint, mut further) = (base.clone(), Vec::new());
    let mut next = base.parameter_values().len();
    for one in vanished.iter().flatten().flatten() {
        further.extend(one.coefficients.iter().map(|coefficient| next + coefficient));
        next += one.effect.parameters.len();
        joint.effects.push(one.effect.clone());
    }
    if further.is_empty() {
        return None;
    }
    let linearised = Linearised::new(&joint, &own, &further, recordings, settings).ok()?;
    let mut first = 0;
    let each = vanished.into_iter().map(|starts| {
        let starts = starts?;
        let is_straight = starts.iter().all(|one| one.is_straight);
        let mut promised: Vec<PromisedStart> = starts
            .into_iter()
            .map(|one| {
                let columns: Vec<usize> = (first..first + one.coefficients.len()).collect();
                first += one.coefficients.len();
                promised_start(&linearised, one, &columns, &own)
            })
            .collect();
        promised.sort_by(|a, b| a.loss.total_cmp(&b.loss));
        let improvement = promised.first().map_or(0.0, |best| linearised.loss_before - best.loss);
        Some(Promised { improvement, starts: promised, is_straight })
    });
    Some(each.collect())
}

/// The start after a step of the coefficients, which are in these `columns`. Uses the best choice of coefficients in
/// which none falls below its minimum.
fn promised_start(linearised: &Linearised, vanished: Vanished, columns: &[usize], own: &[usize]) -> PromisedStart {
    let Vanished { start: mut model, mut effect, coefficients, .. } = vanished;
    let promise_of = |chosen: Vec<usize>| {
        let promise = linearised.promise(&chosen.iter().map(|&number| columns[number]).collect::<Vec<_>>())?;
        let least = chosen.iter().map(|&number| effect.parameters[coefficients[number]].card.minimum);
        let is_possible = least.zip(&promise.values).all(|(least, value)| *value >= least);
        is_possible.then_some((chosen, promise))
    };
    let promises = choices(coefficients.len()).into_iter().filter_map(promise_of);
    let best = promises.min_by(|a, b| a.1.loss.total_cmp(&b.1.loss));
    let mut loss = linearised.loss_before;
    if let Some((chosen, promise)) = best {
        loss = promise.loss;
        let mut values = model.parameter_values();
        for (&index, value) in own.iter().zip(&promise.own) {
            values[index] = *value;
        }
        model.set_parameter_values(&values);
        for (number, value) in chosen.into_iter().zip(promise.values) {
            effect.parameters[coefficients[number]].value = value;
        }
    }
    if let Some(last) = model.effects.last_mut() {
        for (parameter, promised) in last.parameters.iter_mut().zip(effect.parameters) {
            parameter.value = promised.value;
        }
    }
    PromisedStart { model: within_bounds(model), loss }
}

/// Largest number of coefficients for which every subset is tried: a valve leaks past four edges.
const MOST_CHOSEN_FROM: usize = 4;

/// Subsets of `count` coefficients: all subsets, or for a large number the full set and each coefficient alone.
fn choices(count: usize) -> Vec<Vec<usize>> {
    if count > MOST_CHOSEN_FROM {
        return std::iter::once((0..count).collect()).chain((0..count).map(|number| vec![number])).collect();
    }
    let chosen = |choice: usize| (0..count).filter(|number| choice >> number & 1 == 1).collect();
    (1..1 << count).map(chosen).collect()
}

/// Points at which it is checked whether an effect vanishes: the starts of all segments.
struct Probes {
    at: Vec<(Vec<f64>, Inputs<f64>, Vec<f64>)>,
    instruments: Instruments<f64>,
}

/// Rates that differ by less, relative to the largest, are equal.
const SAME: f64 = 1e-9;

impl Probes {
    fn of(base: &Model, recordings: &[&Recording], settings: &FitSettings) -> Self {
        let system = System::new(base);
        let parameters = base.parameter_values();
        let size = base.machine.size();
        let (duration, rate) = (settings.segment_duration_for(&size), settings.sample_rate_for(&size));
        let (mut at, mut workspace) = (Vec::new(), system.workspace());
        for recording in recordings {
            let Ok(cut) = SegmentedRecording::new(base, recording, duration, rate) else { continue };
            for segment in &cut.segments {
                let mut inputs = Inputs::zero(system.layout().joints);
                cut.inputs.between(segment.first, 0.0, &mut inputs);
                let mut rates = vec![0.0; system.layout().len];
                system.rates(&mut workspace, &parameters, &segment.state, &inputs, &mut rates);
                at.push((segment.state.clone(), inputs, rates));
            }
        }
        Probes { at, instruments: system.instruments(&parameters) }
    }

    /// The last effect of a model with its coefficients at zero: the linear ones, or all that can be zero. Returns
    /// `None` if the effect still acts then, or has states.
    fn vanished(&self, start: Model) -> Option<Vanished> {
        let effect = start.effects.last()?;
        let can_be_zero = |index: &usize| {
            let card = &effect.parameters[*index].card;
            !effect.parameters[*index].known && !card.start.is_a_time() && (card.minimum..=card.maximum).contains(&0.0)
        };
        let all: Vec<usize> = (0..effect.parameters.len()).filter(can_be_zero).collect();
        let linear: Vec<usize> =
            all.iter().copied().filter(|&index| effect.parameters[index].card.kind == Kind::Linear).collect();
        let coefficients = [linear, all].into_iter().find(|some| !some.is_empty() && self.vanishes(&start, some))?;
        let mut effect = effect.clone();
        coefficients.iter().for_each(|&index| effect.parameters[index].value = 0.0);
        let is_linear = |&index: &usize| effect.parameters[index].card.kind == Kind::Linear;
        let system = System::new(&start);
        let first = system.parameter_ranges().last().map_or(0, |range| range.0);
        let is_straight = coefficients.iter().all(|index| match system.reach(first + index) {
            Reach::Instruments => true,
            Reach::OwnRows => is_linear(index),
            Reach::Others => false,
        });
        Some(Vanished { effect, coefficients, is_straight, start })
    }

    fn vanishes(&self, start: &Model, coefficients: &[usize]) -> bool {
        let mut model = start.clone();
        let Some(last) = model.effects.last_mut() else { return false };
        coefficients.iter().for_each(|&index| last.parameters[index].value = 0.0);
        let system = System::new(&model);
        let parameters = model.parameter_values();
        let (mut workspace, mut rates) = (system.workspace(), vec![0.0; system.layout().len]);
        !self.at.is_empty()
            && system.instruments(&parameters) == self.instruments
            && self.at.iter().all(|(state, inputs, before)| {
                if state.len() != rates.len() {
                    return false;
                }
                system.rates(&mut workspace, &parameters, state, inputs, &mut rates);
                rates
                    .iter()
                    .zip(before)
                    .all(|(now, before)| (now - before).abs() <= SAME * before.abs().max(f64::MIN_POSITIVE))
            })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;
    use excavator_model::simulation::{Tolerances, simulate_from_rest};

    use super::*;

    /// A recording of the arm with a pump line that leaks.
    fn leaking(coefficient: f64) -> Recording {
        let model = built_in("zx30u-arm").unwrap();
        let (physics, site) = model.parse_addition("pump_leakage").unwrap().remove(0);
        let mut truth = model.with_effect(&physics, site).unwrap();
        truth.effects.last_mut().unwrap().parameters[0].value = coefficient;
        let time: Vec<f64> = (0..4000).map(|index| f64::from(index) * 4e-3).collect();
        let mut recording = Recording::unmeasured("leaking", time, &["arm"]);
        recording.tank_pressure.fill(3e5);
        recording.pump_flow.fill(3.8e-4);
        recording.cylinders[0].orifice_area = recording.time.iter().map(|t| 4e-5 * (3.1 * t).sin()).collect();
        simulate_from_rest(&truth, &recording, &[0.1], Tolerances::default()).unwrap()
    }

    fn wanted(model: &Model, names: &[&str]) -> Vec<Addition> {
        let addition = |name: &&str| {
            let (physics, site) = model.parse_addition(name).unwrap().remove(0);
            Addition { physics, site }
        };
        names.iter().map(addition).collect()
    }

    #[test]
    fn one_simulation_tells_what_is_missing_and_how_large_it_is() {
        let (model, recording) = (built_in("zx30u-arm").unwrap(), leaking(2e-12));
        let names = ["pump_leakage", "hose_loss", "valve_dead_zone", "valve_lag"];
        let promised = promises(&model, &wanted(&model, &names), &[&recording], &FitSettings::default()).unwrap();
        let [Some(leakage), Some(hose), Some(dead_zone), lag] = &promised[..] else { unreachable!() };
        assert!(leakage.is_straight && hose.is_straight && !dead_zone.is_straight);
        assert!(lag.is_none(), "a lag has a state of its own");
        let best = |one: &Promised| one.improvement;
        assert!(best(leakage) > 2.0 * best(hose).max(best(dead_zone)), "{} {}", best(leakage), best(hose));
        let found = leakage.starts[0].model.effects.last().unwrap().parameters[0].value;
        assert!((found / 2e-12 - 1.0).abs() < 0.1, "{found:e}");
    }

    #[test]
    fn of_a_contact_that_nobody_can_place_nothing_is_foretold() {
        let (model, mut recording) = (built_in("zx30u-arm").unwrap(), leaking(2e-12));
        recording.cylinders[0].cap_pressure.fill(f64::NAN);
        recording.cylinders[0].rod_pressure.fill(f64::NAN);
        let wanted = wanted(&model, &["external_contact", "pump_leakage"]);
        let promised = promises(&model, &wanted, &[&recording], &FitSettings::default()).unwrap();
        assert!(promised[0].is_none() && promised[1].is_some());
    }

    #[test]
    fn every_choice_of_a_few_coefficients_is_tried() {
        assert_eq!(choices(2), [vec![0], vec![1], vec![0, 1]]);
        assert_eq!(choices(4).len(), 15);
        assert_eq!(choices(6).len(), 7, "all of them, and each alone");
    }
}
