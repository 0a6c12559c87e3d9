//! Sensitivities carried along a trajectory against finite differences of whole simulations.

use crate::common;
use excavator_model::Model;
use excavator_model::equations::{Channel, System};
use excavator_model::machine::Cylinder;
use excavator_model::simulation::{InputSignals, Integrator, Sensitivity, Tolerances};
use nalgebra::DVector;

const SAMPLES: usize = 800;

/// States at the start and at every tenth sample.
fn simulate(model: &Model, parameters: &[f64], start: &[f64], signals: &InputSignals) -> Vec<f64> {
    let system = System::new(model);
    let mut integrator = Integrator::new(&system, parameters, &[], Tolerances::default().scaled(1e-4));
    let mut state = start.to_vec();
    let mut states = state.clone();
    for index in 0..SAMPLES {
        integrator.advance(signals, index, &mut state, None).unwrap();
        if (index + 1) % 10 == 0 {
            states.extend_from_slice(&state);
        }
    }
    states
}

/// Largest distance between two columns, relative to the largest entry of the second, state by state.
fn relative_distance(found: &[f64], wanted: &[f64], states: usize, scale: &[f64]) -> f64 {
    (0..states)
        .map(|state| {
            let pairs = || found.iter().zip(wanted).skip(state).step_by(states);
            let size = pairs().map(|(_, wanted)| wanted.abs()).fold(scale[state], f64::max);
            pairs().map(|(found, wanted)| (found - wanted).abs()).fold(0.0, f64::max) / size
        })
        .fold(0.0, f64::max)
}

fn driven(model: &Model) -> InputSignals {
    let area = |number: usize, t: f64| 6e-5 * (std::f64::consts::TAU * 0.9 * t + 0.5 + number as f64).sin();
    let recording = common::driven(model, 1.0, 1e-3, area, |t| 300.0 * (std::f64::consts::TAU * 2.0 * t).sin() + 60.0);
    InputSignals::from_recording(model, &recording).unwrap()
}

fn start_of(system: &System<'_>) -> Vec<f64> {
    let mut start = common::at_rest(system);
    for &(first, count) in &system.layout().effect_states {
        start[first..first + count].fill(1e-5);
    }
    start
}

fn scales_of(system: &System<'_>) -> Vec<f64> {
    let layout = system.layout();
    let mut scales = vec![1e5; layout.len];
    scales[..layout.joints].fill(1e-3);
    scales[layout.joints..2 * layout.joints].fill(1e-2);
    for (state, scale) in system.state_scales() {
        scales[state] = 0.1 * scale;
    }
    scales
}

/// Sensitivities of all states at every tenth sample, a column for each parameter and each initial state.
fn sensitivities(model: &Model, settings: Tolerances) -> Vec<Vec<f64>> {
    let signals = driven(model);
    let system = System::new(model);
    let parameters = model.parameter_values();
    let wanted = model.unknown_parameters();
    let mut integrator = Integrator::new(&system, &parameters, &wanted, settings);
    let mut sensitivity = Sensitivity::at_start(&system, &wanted);
    let mut state = start_of(&system);
    let mut columns: Vec<Vec<f64>> = (0..sensitivity.width()).map(|column| sensitivity.by_column(column)).collect();
    for index in 0..SAMPLES {
        integrator.advance(&signals, index, &mut state, Some(&mut sensitivity)).unwrap();
        if (index + 1) % 10 == 0 {
            for (number, column) in columns.iter_mut().enumerate() {
                column.extend(sensitivity.by_column(number));
            }
        }
    }
    columns
}

/// What a column of sensitivities is for, the central differences of simulations that stand for it, and the least size of each state
/// that counts.
struct Slopes {
    what: String,
    differences: Vec<f64>,
    least: Vec<f64>,
}

fn slopes(model: &Model) -> Vec<Slopes> {
    let signals = driven(model);
    let system = System::new(model);
    let (parameters, start) = (model.parameter_values(), start_of(&system));
    let wanted = model.unknown_parameters();
    let state_scale = scales_of(&system);
    let mut slopes = Vec::with_capacity(wanted.len() + start.len());
    for number in 0..wanted.len() + start.len() {
        let (mut upper, mut lower) = ((parameters.clone(), start.clone()), (parameters.clone(), start.clone()));
        let (what, step, whole) = if number < wanted.len() {
            let index = wanted[number];
            let card = &model.parameters().nth(index).unwrap().1.card;
            let whole = if parameters[index] == 0.0 { card.typical } else { parameters[index].abs() };
            let step = 1e-4 * whole;
            upper.0[index] += step;
            lower.0[index] -= step;
            (card.name.to_string(), step, whole)
        } else {
            let index = number - wanted.len();
            let step = 1e-3 * state_scale[index];
            upper.1[index] += step;
            lower.1[index] -= step;
            (format!("initial state {index}"), step, state_scale[index])
        };
        let upper = simulate(model, &upper.0, &upper.1, &signals);
        let lower = simulate(model, &lower.0, &lower.1, &signals);
        let differences: Vec<f64> = upper.iter().zip(&lower).map(|(u, l)| (u - l) / (2.0 * step)).collect();
        // A state that the whole parameter would move by less than a thousandth of its scale is not moved.
        let least: Vec<f64> = state_scale.iter().map(|scale| 1e-3 * scale / whole).collect();
        slopes.push(Slopes { what, differences, least });
    }
    slopes
}

/// Checks the median and the largest relative error of all columns.
fn check(model: &Model, slopes: &[Slopes], settings: Tolerances, median: f64, largest: f64) {
    let columns = sensitivities(model, settings);
    assert_eq!(columns.len(), slopes.len());
    let mut errors: Vec<(&str, f64)> = columns
        .iter()
        .zip(slopes)
        .map(|(found, slopes)| {
            let error = relative_distance(found, &slopes.differences, slopes.least.len(), &slopes.least);
            (slopes.what.as_str(), error)
        })
        .collect();
    errors.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (middle, (worst, error)) = (errors[errors.len() / 2].1, errors.last().unwrap());
    let name = format!("{} with {}", model.machine.name, model.effects.last().unwrap().name());
    println!("{name}, steps to {} s: median {middle:.1e}, largest {error:.1e} by {worst}", settings.maximum_step);
    assert!(middle < median, "{name}: median {middle}");
    assert!(*error < largest, "{name}: {error} by {worst}");
}

/// With one step per sample of 1 ms: two hundredths for most, and 20 % for what one step does not resolve: initial
/// pressures out of balance, which settle within the first millisecond, and chambers that leave cavitation as the valve
/// changes direction. With steps of 0.1 ms: a hundredth for all, so the sensitivities converge to the slopes. A bucket has a
/// tenth of an arm's inertia, and what a pressure out of balance does to it is over sooner: a tenth with the finer steps. Oil in a
/// motor is stiffer still: a third.
fn check_machines(models: impl IntoIterator<Item = Model>) {
    common::each(models, |model| {
        let three_joints = model.machine.cylinders.len() >= 3;
        // Charge valves act within less than a sample interval.
        let charged = model.effects.iter().any(|effect| effect.name() == "charge_check_valve");
        let median = if charged || model.machine.cylinders[0].is_motor() { 0.05 } else { 0.02 };
        // A check valve is open for moments that no difference of parameters hits.
        let coarse = if three_joints || charged { 1.0 } else { 0.2 };
        let slopes = slopes(&model);
        check(&model, &slopes, Tolerances::default(), median, coarse);
        let motor = model.machine.cylinders.iter().any(Cylinder::is_motor);
        // So is a regulator at its limits.
        let has_corners = charged || model.effects.iter().any(|effect| effect.name() == "load_sensing_pump");
        let largest = match (motor, three_joints, has_corners) {
            (true, ..) => 0.3,
            (_, true, _) => 0.1,
            (.., true) => 1.0,
            _ => 0.01,
        };
        check(&model, &slopes, fine(), if has_corners { 5e-3 } else { 1e-3 }, largest);
    });
}

#[test]
fn sensitivities_are_the_slopes_of_simulations() {
    check_machines(["zx30u-arm", "servo-bench"].map(|name| excavator_model::document::built_in(name).unwrap()));
}

fn fine() -> Tolerances {
    Tolerances { maximum_step: 1e-4, ..Tolerances::default() }
}

/// What instruments see, from what states do.
#[test]
fn output_sensitivities_are_slopes() {
    let model = excavator_model::document::built_in("zx30u").unwrap();
    let system = System::new(&model);
    let state = [1.4, 4.9, 0.2, -0.3, 1e6, 1e6, 1e6, 1e6, 1e6];
    for (cylinder, described) in model.machine.cylinders.iter().enumerate() {
        let [(_, displacement_by_joint), _] = Channel::Displacement(cylinder).gradient(&system, &state);
        let [(_, velocity_by_joint), (_, velocity_by_rate)] = Channel::Velocity(cylinder).gradient(&system, &state);
        let (joint, rate, step) = (state[cylinder], state[2 + cylinder], 1e-6);
        let linkage = &described.linkage;
        let by_joint = |of: &dyn Fn(f64) -> f64| (of(joint + step) - of(joint - step)) / (2.0 * step);
        let pairs = [
            (displacement_by_joint, by_joint(&|q| linkage.displacement(q))),
            (velocity_by_joint, by_joint(&|q| linkage.lever(q) * rate)),
            (velocity_by_rate, linkage.lever(joint)),
        ];
        for (found, wanted) in pairs {
            assert!((found - wanted).abs() < 1e-8, "{cylinder}: {found} {wanted}");
        }
    }
}

/// A caller may change the state between samples, as shooting methods do: nothing may be remembered from before.
#[test]
fn a_state_set_by_the_caller_is_noticed() {
    let model = excavator_model::document::built_in("zx30u-arm").unwrap();
    let recording = common::driven(&model, 0.1, 1e-3, |_, t| 5e-5 + 1e-4 * t, |_| 0.0);
    let signals = InputSignals::from_recording(&model, &recording).unwrap();
    let system = System::new(&model);
    let parameters = model.parameter_values();
    let wanted = model.unknown_parameters();
    let start = common::at_rest(&system);
    let mut used = Integrator::new(&system, &parameters, &wanted, Tolerances::default());
    let mut state = start.clone();
    let mut sensitivity = Sensitivity::at_start(&system, &wanted);
    for index in 0..10 {
        used.advance(&signals, index, &mut state, Some(&mut sensitivity)).unwrap();
    }
    let result = |integrator: &mut Integrator<'_, '_>| {
        let mut state = start.clone();
        let mut sensitivity = Sensitivity::at_start(&system, &wanted);
        integrator.advance(&signals, 10, &mut state, Some(&mut sensitivity)).unwrap();
        let columns = (0..sensitivity.width()).flat_map(|column| sensitivity.by_column(column));
        (state, DVector::from_iterator(start.len() * sensitivity.width(), columns))
    };
    let mut fresh = Integrator::new(&system, &parameters, &wanted, Tolerances::default());
    let (from_used, from_fresh) = (result(&mut used), result(&mut fresh));
    let settings = Tolerances::default();
    let tolerances = [settings.joint, settings.rate, settings.pressure, settings.pressure, settings.pressure];
    for ((used, fresh), absolute) in from_used.0.iter().zip(&from_fresh.0).zip(tolerances) {
        // The step size is remembered, and may be; errors stay below the tolerance.
        assert!((used - fresh).abs() <= absolute + settings.relative * fresh.abs(), "{used} {fresh}");
    }
    assert!((from_used.1 - &from_fresh.1).norm() <= 1e-2 * from_fresh.1.norm());
}

/// `tests/run --all` runs these.
mod full {
    use super::*;

    #[test]
    fn sensitivities_are_the_slopes_of_simulations_of_every_machine() {
        check_machines(common::machines());
    }

    #[test]
    fn sensitivities_with_each_effect_added() {
        let base = excavator_model::document::built_in("zx30u-arm").unwrap();
        let catalogue = common::catalogue();
        let cases =
            catalogue.iter().flat_map(|physics| base.free_sites(physics).into_iter().map(move |site| (physics, site)));
        common::each(cases, |(physics, site)| {
            let model = common::with_typical(&base, physics, site);
            // A regulator that is at its limits has corners there.
            let is_regulated = physics.card().name == "load_sensing_pump";
            let slopes = slopes(&model);
            check(&model, &slopes, Tolerances::default(), 0.02, if is_regulated { 0.2 } else { 0.1 });
            check(&model, &slopes, fine(), 2e-3, if is_regulated { 0.2 } else { 0.02 });
        });
    }
}
