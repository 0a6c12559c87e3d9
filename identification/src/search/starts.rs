//! Start values for the fit of a candidate effect.

use excavator_model::Model;
use excavator_model::effects::{Effect, Kind, Site, Start};
use excavator_model::machine::Machine;
use excavator_model::recording::Recording;

use super::worst_stretch::worst_stretches;
use crate::regression::{Ground, WeakFormSettings, weak_form, weak_form_on};

/// The model with the last effect's parameters at each combination of their start values. Each combination is also
/// improved by a regression on the equations, which finds linear coefficients without a search, however far they are
/// from any start. Regressed starts come first. `ground` holds the recordings as seen by the model without its last
/// effect, if known.
pub(super) fn starts(model: &Model, recordings: &[&Recording], ground: Option<&Ground>) -> Vec<Model> {
    let plain = plain_starts(model, recordings);
    let sees_the_same = model.effects.last().is_some_and(|last| Ground::holds_for(&*last.physics));
    let ground = ground.filter(|_| sees_the_same);
    let thinned = if ground.is_some() { Vec::new() } else { thinned(model, recordings) };
    let thinned: Vec<&Recording> = thinned.iter().collect();
    let quick =
        WeakFormSettings { rounds: 1, with_errors: false, hold_at_bounds: false, ..WeakFormSettings::default() };
    let regressed = |start: &Model| {
        let regression = match ground {
            Some(ground) => weak_form_on(ground, start, &quick),
            None => weak_form(start, &thinned, &quick),
        };
        Some(within_bounds(regression.ok()?.model))
    };
    let last = model.effects.last();
    if last.is_some_and(|last| can_be_transient(&*last.physics, &model.machine, last.site)) {
        // There are many windows, and the strength of an effect follows from its window.
        let with_strength = |start: &Model| Some(with_shape_of(start, regressed(&with_shape_held(start))?));
        return plain.into_iter().map(|start| with_strength(&start).unwrap_or(start)).collect();
    }
    if last.is_some_and(|last| last.physics.formula().is_some()) {
        // A joint step in the coefficient of an opening and in the gains behind it diverges. Each gain for a given
        // coefficient is right.
        let with_others = |start: &Model| Some(with_shape_of(start, regressed(&with_shape_held(start))?));
        let has_shape = |start: &&Model| {
            start.effects.last().is_some_and(|law| law.parameters.iter().any(|one| one.card.kind == Kind::Shape))
        };
        let held: Vec<Model> = plain.iter().filter(has_shape).filter_map(with_others).collect();
        return plain.iter().filter_map(regressed).chain(held).chain(plain.iter().cloned()).collect();
    }
    plain.iter().filter_map(regressed).chain(plain.iter().cloned()).collect()
}

/// The model with its last effect held, except for its strength. A regression sees an edge in a few windows only, and
/// one step of it from there can be years long. It can also move a light load to where it has no effect, and no fit
/// returns from there.
fn with_shape_held(model: &Model) -> Model {
    let mut held = model.clone();
    let last = held.effects.last_mut().into_iter().flat_map(|effect| &mut effect.parameters);
    last.filter(|parameter| parameter.card.kind == Kind::Shape).for_each(|parameter| parameter.known = true);
    held
}

/// `model` with the parameters of its last effect held or free as in `start`.
fn with_shape_of(start: &Model, mut model: Model) -> Model {
    let last = model.effects.last_mut().into_iter().flat_map(|effect| &mut effect.parameters);
    let same = start.effects.last().into_iter().flat_map(|effect| &effect.parameters);
    last.zip(same).for_each(|(parameter, same)| parameter.known = same.known);
    model
}

/// Samples per second of the regressions that provide starts, on a machine of the reference size. At 170 Hz the start
/// value of a contact that lasts seconds is lost.
const START_RATE: f64 = 250.0;

/// Thins recordings to this rate. A regression still finds useful starts, in half the time.
fn thinned(model: &Model, recordings: &[&Recording]) -> Vec<Recording> {
    let rate = START_RATE / model.machine.size().time();
    let stride = |recording: &Recording| (1.0 / (recording.sample_interval() * rate)).round();
    let whole = |stride: f64| if stride.is_finite() { (stride as usize).max(1) } else { 1 };
    recordings.iter().map(|recording| recording.thinned(whole(stride(recording)))).collect()
}

/// The recordings as `model` sees them, thinned for [`starts`]. Returns `None` if it cannot be simulated.
pub(super) fn ground(model: &Model, recordings: &[&Recording]) -> Option<Ground> {
    Ground::new(model, thinned(model, recordings)).ok()
}

/// Moves unknown parameters to the nearest possible value.
pub(super) fn within_bounds(mut model: Model) -> Model {
    for parameter in model.parameters_mut().filter(|parameter| !parameter.known) {
        parameter.value = parameter.value.clamp(parameter.card.minimum, parameter.card.maximum);
    }
    model
}

/// Whether an effect can act in a window of time. A window belongs to one recording and is not valid for another.
pub(super) fn can_be_transient(physics: &dyn Effect, machine: &Machine, site: Site) -> bool {
    physics.parameters(machine, site).iter().any(|card| card.start.is_a_time())
}

/// Number of worst stretches that are used for start windows.
const WINDOWS: usize = 2;

/// The model with the last effect in windows of time in which it may have acted. If an effect acts all the time except
/// in a stretch, the fitted gravity absorbs its weight, and the model without it fails in that stretch. So the window
/// may be a stretch in which that model fails most, all that comes before or after it, or the time between two such
/// stretches. It may also be the whole time, if the effect can act always.
fn windows(model: &Model, recordings: &[&Recording]) -> Vec<Model> {
    let mut without = model.clone();
    let Some(last) = without.effects.pop() else { return Vec::new() };
    let stretches: Vec<(f64, f64)> = worst_stretches(&without, last.site, recordings, WINDOWS)
        .into_iter()
        .map(|stretch| (stretch.begin, stretch.begin + stretch.duration))
        .collect();
    let mut windows: Vec<Model> =
        stretches.iter().map(|&(begin, end)| in_window(model, Some(begin), Some(end))).collect();
    if let Some(&(begin, end)) = stretches.first() {
        windows.push(in_window(model, Some(end), None));
        windows.push(in_window(model, None, Some(begin)));
    }
    if let [one, other] = stretches[..] {
        let (end, begin) = (one.1.min(other.1), one.0.max(other.0));
        windows.push(in_window(model, Some(end), Some(begin)));
    }
    if last.acts_always() {
        windows.push(model.clone());
    }
    windows
}

/// The model with the window of its last effect open to either side. A load that was never put down, but lay still for
/// a while, looks like one that was put down. A fit moves an edge only as far as the recording shows it.
pub(super) fn half_open(model: &Model) -> Vec<Model> {
    match model.effects.last().and_then(|last| last.window()) {
        Some((begin, duration)) if !begin.known && !duration.known => {
            let end = begin.value + duration.value;
            vec![in_window(model, Some(begin.value), None), in_window(model, None, Some(end))]
        }
        _ => Vec::new(),
    }
}

/// The model with the last effect from `begin` to `end`, s; an edge that is not given lies outside every recording and
/// is held.
fn in_window(model: &Model, begin: Option<f64>, end: Option<f64>) -> Model {
    let mut start = model.clone();
    let mut first = 0.0;
    let shortest = SHORTEST * model.machine.size().time();
    for parameter in start.effects.iter_mut().rev().take(1).flat_map(|effect| &mut effect.parameters) {
        match &parameter.card.start {
            Start::WorstStretchBegin => {
                parameter.value = begin.unwrap_or(parameter.card.minimum);
                parameter.known = begin.is_none();
                first = parameter.value;
            }
            Start::WorstStretchDuration => {
                parameter.value = end.map_or(parameter.card.maximum, |end| (end - first).max(shortest));
                parameter.known = end.is_none();
            }
            Start::At(_) | Start::PumpPressureQuantiles(_) | Start::Known(_) => {}
        }
    }
    start
}

/// Shortest window that a search begins with, s, on a machine of the reference size.
const SHORTEST: f64 = 0.2;

/// The model with the last effect's parameters at each combination of their start values.
pub(super) fn plain_starts(model: &Model, recordings: &[&Recording]) -> Vec<Model> {
    let Some(last) = model.effects.last() else { return vec![model.clone()] };
    let mut starts = if can_be_transient(&*last.physics, &model.machine, last.site) {
        windows(model, recordings)
    } else {
        vec![model.clone()]
    };
    for (number, parameter) in last.parameters.iter().enumerate() {
        let values: Vec<f64> = match &parameter.card.start {
            // The windows set these.
            Start::WorstStretchBegin | Start::WorstStretchDuration => continue,
            Start::Known(_) => continue,
            Start::At(values) => values.to_vec(),
            Start::PumpPressureQuantiles(levels) => {
                levels.iter().map(|&level| pump_pressure(recordings, level)).collect()
            }
        };
        let values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        if parameter.card.kind != Kind::Shape && values.len() < 2 || values.is_empty() {
            continue;
        }
        starts = starts
            .iter()
            .flat_map(|start| {
                values.iter().map(|&value| {
                    let mut start = start.clone();
                    if let Some(effect) = start.effects.last_mut() {
                        effect.parameters[number].value = value;
                    }
                    start
                })
            })
            .collect();
    }
    starts
}

pub(super) fn pump_pressure(recordings: &[&Recording], level: f64) -> f64 {
    let mut values: Vec<f64> = recordings
        .iter()
        .flat_map(|recording| recording.pump_pressure.iter().copied())
        .filter(|value| value.is_finite())
        .collect();
    if values.is_empty() {
        return f64::NAN;
    }
    let position = ((values.len() - 1) as f64 * level) as usize;
    *values.select_nth_unstable_by(position, f64::total_cmp).1
}
