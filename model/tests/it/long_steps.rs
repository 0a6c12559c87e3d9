//! Steps over several samples: as good as steps from sample to sample, and fewer.

use crate::common;
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::equations::System;
use excavator_model::simulation::{InputSignals, Integrator, SimulationError, Tolerances};

/// Noise of good sensors that the error has to stay well below: displacement or angle (m, rad), their rates, Pa.
const NOISE: [f64; 3] = [5e-5, 5e-3, 2000.0];

fn area(number: usize, time: f64) -> f64 {
    if time < 6.0 {
        return 1e-4 * (std::f64::consts::TAU * 0.5 * time + number as f64).sin();
    }
    let into = (time - 6.0) % 3.0;
    6e-5 * (into / 0.5).min((2.5 - into) / 0.5).clamp(0.0, 1.0)
}

fn signals(model: &Model, noise: f64) -> InputSignals {
    let mut recording = common::driven(model, 12.0, 1e-3, area, |t| 100.0 * (3.0 * t).sin());
    let mut random = common::Random(11);
    for area in recording.cylinders.iter_mut().flat_map(|cylinder| &mut cylinder.orifice_area) {
        *area += noise * random.normal();
    }
    InputSignals::from_recording(model, &recording).unwrap()
}

/// States at all samples and the number of accepted steps.
fn follow(model: &Model, signals: &InputSignals, tolerances: Tolerances) -> (Vec<Vec<f64>>, usize) {
    let system = System::new(model);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], tolerances);
    let mut state = common::at_rest(&system);
    let mut states = Vec::new();
    integrator
        .follow(signals, &mut state, |index, state| {
            assert_eq!(index, states.len());
            states.push(state.to_vec());
        })
        .unwrap();
    assert_eq!(states.last(), Some(&state));
    (states, integrator.steps.0)
}

/// The trajectory by single steps, exact to a thousandth of the usual tolerance.
fn exact(model: &Model, signals: &InputSignals) -> Vec<Vec<f64>> {
    by_single_steps(model, signals, Tolerances::default().scaled(1e-3))
}

fn by_single_steps(model: &Model, signals: &InputSignals, tolerances: Tolerances) -> Vec<Vec<f64>> {
    let system = System::new(model);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], tolerances);
    let mut state = common::at_rest(&system);
    let mut states = vec![state.clone()];
    for index in 0..signals.len() - 1 {
        integrator.advance(signals, index, &mut state, None).unwrap();
        states.push(state.clone());
    }
    states
}

/// Root mean square distance of each state from the exact one, in units of sensor noise.
fn errors(model: &Model, found: &[Vec<f64>], exact: &[Vec<f64>]) -> Vec<f64> {
    assert_eq!(found.len(), exact.len());
    let layout = System::new(model).layout().clone();
    (0..layout.len)
        .map(|state| {
            let joints = 0..layout.joints;
            let noise = if joints.clone().any(|joint| layout.joint(joint) == state) {
                NOISE[0]
            } else if joints.clone().any(|joint| layout.rate(joint) == state) {
                NOISE[1]
            } else {
                NOISE[2]
            };
            let squares: f64 = found.iter().zip(exact).map(|(a, b)| (a[state] - b[state]).powi(2)).sum();
            (squares / found.len() as f64).sqrt() / noise
        })
        .collect()
}

#[test]
fn long_steps_are_exact_at_every_sample() {
    for name in ["zx30u-arm", "zx30u", "servo-bench", "emps"] {
        let model = built_in(name).unwrap();
        for noise in [0.0, 2e-7] {
            let signals = signals(&model, noise);
            let (states, steps) = follow(&model, &signals, Tolerances::default());
            let exact = exact(&model, &signals);
            let single = by_single_steps(&model, &signals, Tolerances::default());
            let of_single = errors(&model, &single, &exact);
            let errors = errors(&model, &states, &exact);
            println!(
                "{name}, spool noise {noise:e} m2: {steps} steps for {} samples, errors {errors:.3?}",
                states.len()
            );
            // A seventh of the noise adds a fiftieth to its variance.
            for (error, single) in errors.iter().zip(of_single) {
                assert!(*error < f64::max(0.15, 1.1 * single), "{name}: {error}, with single steps {single}");
            }
            if noise == 0.0 {
                assert!(2 * steps < states.len(), "{name}: {steps} steps");
            }
        }
    }
}

#[test]
fn the_error_falls_with_the_tolerance() {
    let model = built_in("zx30u-arm").unwrap();
    let signals = signals(&model, 0.0);
    let exact = exact(&model, &signals);
    let worst = |factor: f64| {
        let (states, _) = follow(&model, &signals, Tolerances::default().scaled(factor));
        errors(&model, &states, &exact).into_iter().fold(0.0, f64::max)
    };
    let (loose, tight) = (worst(1.0), worst(0.01));
    println!("errors {loose:.4} and {tight:.4} of sensor noise");
    assert!(tight < 0.3 * loose);
}

#[test]
fn a_state_that_is_no_number_is_told() {
    let model = built_in("zx30u-arm").unwrap();
    let signals = signals(&model, 0.0);
    let system = System::new(&model);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], Tolerances::default());
    let mut state = vec![f64::NAN; system.layout().len];
    let error = integrator.follow(&signals, &mut state, |_, _| {}).unwrap_err();
    assert!(matches!(error, SimulationError::NotFinite { .. }), "{error}");
}
