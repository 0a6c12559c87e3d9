//! What the first step of many additions promises, from one simulation.
//!
//! An effect that vanishes where its coefficients are zero changes the outputs of the model that it is added to in proportion to them, at
//! first. One simulation with sensitivities to the coefficients of all such effects tells how far each could lower the error, and with
//! which values. What promises nothing there needs no simulation of its own.

use excavator_model::effects::Kind;
use excavator_model::equations::{Inputs, Instruments, Reach, System};
use excavator_model::recording::Recording;
use excavator_model::{Model, ModelEffect};

use super::Addition;
use super::starts::{plain_starts, within_bounds};
use crate::fit::{FitSettings, Linearised, SegmentedRecording};

/// What is foretold of one addition.
pub(super) struct Promised {
    /// Fall of the loss that the best of its starts promises.
    pub improvement: f64,
    /// Its starts, the most promising first.
    pub starts: Vec<PromisedStart>,
    /// Whether its outputs go on as they begin: it adds to its own rows in proportion to its coefficients, or to what instruments report.
    /// What shifts an opening may promise nothing at first, and explain much where it is large.
    pub is_straight: bool,
}

/// A start, and what it promises.
pub(super) struct PromisedStart {
    /// The model with the addition.
    pub model: Model,
    /// Loss that the step to there promises; see [`crate::fit::Fit::loss`].
    pub loss: f64,
}

/// An effect with its coefficients at zero.
struct Vanished {
    /// The model with it at its start values.
    start: Model,
    effect: ModelEffect,
    /// Which of its parameters are its coefficients.
    coefficients: Vec<usize>,
    is_straight: bool,
}

/// Foretells what each of the `wanted` additions to `base` brings; `None` for one that vanishes nowhere, of which a simulation of its own
/// has to tell. `None` where that holds for all, or the model cannot be simulated on these recordings.
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
            starts.map(|start| probes.vanished(start)).collect::<Option<Vec<_>>>()
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

/// The start to which a step of the coefficients leads, which are in these `columns`. One that the step would have where it cannot be stays
/// at the nearest possible value.
fn promised_start(linearised: &Linearised, vanished: Vanished, columns: &[usize], own: &[usize]) -> PromisedStart {
    let Vanished { start: mut model, mut effect, coefficients, .. } = vanished;
    let mut free: Vec<usize> = (0..coefficients.len()).collect();
    let mut loss = linearised.loss_before;
    while !free.is_empty() {
        let chosen: Vec<usize> = free.iter().map(|&number| columns[number]).collect();
        let Some(promise) = linearised.promise(&chosen) else { break };
        let is_possible = |number: usize, value: f64| {
            let card = &effect.parameters[coefficients[number]].card;
            (card.minimum..=card.maximum).contains(&value)
        };
        let possible: Vec<usize> = free
            .iter()
            .zip(&promise.values)
            .filter(|(number, value)| is_possible(**number, **value))
            .map(|(n, _)| *n)
            .collect();
        if possible.len() == free.len() {
            for (&number, value) in free.iter().zip(&promise.values) {
                effect.parameters[coefficients[number]].value = *value;
            }
            let mut values = model.parameter_values();
            for (&index, value) in own.iter().zip(&promise.own) {
                values[index] = *value;
            }
            model.set_parameter_values(&values);
            loss = promise.loss;
            break;
        }
        free = possible;
    }
    if let Some(last) = model.effects.last_mut() {
        for (parameter, promised) in last.parameters.iter_mut().zip(effect.parameters) {
            parameter.value = promised.value;
        }
    }
    PromisedStart { model: within_bounds(model), loss }
}

/// Where it is tried whether an effect vanishes: the beginnings of all segments.
struct Probes {
    at: Vec<(Vec<f64>, Inputs<f64>, Vec<f64>)>,
    instruments: Instruments<f64>,
}

/// A rate that differs by less, relative to the largest, is the same.
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

    /// The last effect of a model with its coefficients at zero: those that are linear, or all that can be zero. `None` where it is still
    /// there then, or has states.
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
