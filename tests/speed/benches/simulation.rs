//! What a simulation and its parts cost; `tests/speed` has them beside the solvers of others.
//!
//! 38 s of the arm at 1 kHz: the sine of \[A\] for 24 s, then trapezoids, each as a recording would give it.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

#[path = "../../../model/tests/it/common/mod.rs"]
mod common;

use std::hint::black_box;
use std::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
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

fn signals(model: &Model) -> InputSignals {
    let recording = common::driven(model, DURATION, INTERVAL, area, |_| 0.0);
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

fn simulation(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("simulation");
    group.sample_size(10).measurement_time(Duration::from_secs(4)).warm_up_time(Duration::from_secs(1));
    for name in ["zx30u-arm", "zx30u"] {
        let model = built_in(name).unwrap();
        let signals = signals(&model);
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
