//! How much faster than real time the simulation is, beside `diffsol` on the same trajectory.
//!
//! 38 s of the arm at 1 kHz: the sine of \[A\] for 24 s, then trapezoids, each as a recording would give it. The target is
//! 300 times real time.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

#[path = "../tests/common/mod.rs"]
mod common;
#[path = "../tests/common/diffsol_reference.rs"]
mod diffsol_reference;

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use diffsol_reference::{Method, solve};
use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::energy::Accountant;
use excavator_model::equations::{Inputs, System};
use excavator_model::simulation::{InputSignals, Integrator, Linearisation, Sensitivity, Tolerances};

const DURATION: f64 = 38.0;
const INTERVAL: f64 = 1e-3;

fn area(number: usize, time: f64) -> f64 {
    if time < 24.0 {
        return 1e-4 * (std::f64::consts::TAU * 0.5 * time + number as f64).sin();
    }
    let (into, count) = ((time - 24.0) % 3.5, ((time - 24.0) / 3.5) as usize + number);
    let height = (into / 0.5).min((3.0 - into) / 0.5).clamp(0.0, 1.0);
    6e-5 * height * if count % 2 == 0 { 1.0 } else { -1.0 }
}

/// The inputs; `noise` (m²) is the standard deviation of a spool sensor, of which what denoising leaves stays in.
fn signals(model: &Model, noise: f64) -> InputSignals {
    let mut recording = common::driven(model, DURATION, INTERVAL, area, |_| 0.0);
    let mut random = common::Random(7);
    for area in recording.cylinders.iter_mut().flat_map(|cylinder| &mut cylinder.orifice_area) {
        *area += noise * random.normal();
    }
    InputSignals::from_recording(model, &recording).unwrap()
}

/// The states at all samples; with sensitivities to all unknown parameters if asked.
fn run(model: &Model, signals: &InputSignals, with_sensitivities: bool) -> Vec<Vec<f64>> {
    let system = System::new(model);
    let wanted = if with_sensitivities { model.unknown_parameters() } else { Vec::new() };
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &wanted, Tolerances::default());
    let mut state = common::at_rest(&system);
    let mut sensitivity = with_sensitivities.then(|| Sensitivity::at_start(&system, &wanted));
    let mut states = Vec::with_capacity(signals.len());
    let Some(sensitivity) = &mut sensitivity else {
        integrator.follow(signals, &mut state, |_, state| states.push(state.to_vec())).unwrap();
        return states;
    };
    states.push(state.clone());
    for index in 0..signals.len() - 1 {
        integrator.advance(signals, index, &mut state, Some(sensitivity)).unwrap();
        states.push(state.clone());
    }
    states
}

/// Root mean square distance of the pressures of two trajectories, Pa.
fn distance(model: &Model, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let first = 2 * System::new(model).layout().joints;
    let squares = a.iter().zip(b).flat_map(|(a, b)| a[first..].iter().zip(&b[first..]).map(|(a, b)| (a - b).powi(2)));
    (squares.sum::<f64>() / (a.len() * (a[0].len() - first)) as f64).sqrt()
}

/// The same trajectory by diffsol at a relative tolerance.
fn run_diffsol(model: &Model, signals: &InputSignals, method: Method, tolerance: f64) -> Result<Vec<Vec<f64>>, String> {
    let inputs_at = |time: f64, inputs: &mut Inputs<f64>| {
        let index = ((time / INTERVAL) as usize).min(signals.len() - 2);
        signals.between(index, ((time - signals.time[index]) / INTERVAL).clamp(0.0, 1.0), inputs);
    };
    let start = common::at_rest(&System::new(model));
    solve(model, &start, &signals.time, inputs_at, method, tolerance)
}

fn best_of(repeats: usize, mut work: impl FnMut()) -> f64 {
    let time = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    (0..repeats).map(|_| time(&mut work)).fold(f64::INFINITY, f64::min)
}

fn figures() {
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        for (input, noise) in [("computed input", 0.0), ("measured input", 5e-7)] {
            let signals = signals(&model, noise);
            let plain = best_of(5, || drop(black_box(run(&model, &signals, false))));
            let sensitive = best_of(5, || drop(black_box(run(&model, &signals, true))));
            println!(
                "{name}, {input}: {:.0} times real time, with sensitivities to {} parameters and {} initial states {:.0} times",
                DURATION / plain,
                model.unknown_parameters().len(),
                System::new(&model).layout().len,
                DURATION / sensitive
            );
            let reference = run_diffsol(&model, &signals, Method::Bdf, 1e-8).unwrap();
            let error = distance(&model, &run(&model, &signals, false), &reference);
            println!("    error of pressures {error:.1} Pa");
            // At the tolerance at which diffsol is as exact; the largest one that is tried is ours.
            for method in [Method::Bdf, Method::TrBdf2, Method::Esdirk34] {
                for tolerance in [1e-4, 1e-5, 1e-6, 1e-7] {
                    let start = Instant::now();
                    let Ok(theirs) = run_diffsol(&model, &signals, method, tolerance) else {
                        println!("    diffsol {method:?} at {tolerance:e} does not get through");
                        break;
                    };
                    let (time, their_error) = (start.elapsed().as_secs_f64(), distance(&model, &theirs, &reference));
                    println!(
                        "    diffsol {method:?} at {tolerance:e}: {:.2} times as long, error {their_error:.1} Pa",
                        time / plain
                    );
                    if their_error <= error {
                        break;
                    }
                }
            }
        }
    }
}

fn simulation(criterion: &mut Criterion) {
    figures();
    let mut group = criterion.benchmark_group("simulation");
    group.sample_size(10).measurement_time(Duration::from_secs(4)).warm_up_time(Duration::from_secs(1));
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        let signals = signals(&model, 0.0);
        group.bench_function(format!("{name} 38 s"), |b| b.iter(|| run(&model, &signals, false)));
        group.bench_function(format!("{name} 38 s with sensitivities"), |b| b.iter(|| run(&model, &signals, true)));
        let system = System::new(&model);
        let (state, parameters) = (common::at_rest(&system), model.parameter_values());
        let mut inputs = Inputs::zero(system.layout().joints);
        signals.between(300, 0.0, &mut inputs);
        let (mut workspace, mut rates) = (system.workspace(), vec![0.0; state.len()]);
        group.bench_function(format!("{name} rates"), |b| {
            b.iter(|| system.rates(&mut workspace, &parameters, black_box(&state), &inputs, &mut rates));
        });
        for (what, wanted) in [("states", Vec::new()), ("states and parameters", model.unknown_parameters())] {
            let mut linearisation = Linearisation::new(&system, &wanted);
            group.bench_function(format!("{name} linearisation by {what}"), |b| {
                b.iter(|| linearisation.evaluate(&system, &parameters, black_box(&state), &inputs));
            });
        }
        let mut accountant = Accountant::new(&system);
        group.bench_function(format!("{name} ledger"), |b| {
            b.iter(|| accountant.ledger(&parameters, black_box(&state), &inputs));
        });
    }
    group.finish();
}

criterion_group!(benches, simulation);
criterion_main!(benches);
