//! The simulation, beside other solvers at the same error.
//!
//! 38 s of the arm at 1 kHz: the sine of \[A\] for 24 s, then trapezoids, computed or with what denoising leaves of a spool
//! sensor's noise. Every solver follows the same inputs; errors are against diffsol's backward differences at 1e-9.

use std::time::Instant;

use excavator_model::Model;
use excavator_model::document::{built_in, to_text};
use excavator_model::equations::System;
use excavator_model::simulation::{InputSignals, Integrator, Sensitivity, Tolerances};
use serde_json::json;

use crate::clock::best_of;
use crate::common;
use crate::diffsol::{Method, solve};
use crate::figures::{Group, Run};
use crate::peers::Peers;

const DURATION: f64 = 38.0;
const INTERVAL: f64 = 1e-3;
/// Standard deviation of what stays of a spool sensor's noise, m².
const SPOOL_NOISE: f64 = 5e-7;
const REPETITIONS: usize = 5;
/// Relative tolerances that the other solvers are tried at, coarse to fine; the first that is as exact as we are counts.
const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];

/// Both inputs.
///
/// # Errors
/// In words, where our simulation or the reference does not get through.
pub fn simulation(peers: &Peers) -> Result<Vec<Group>, String> {
    let inputs = [("computed input", 0.0), ("measured input", SPOOL_NOISE)];
    inputs.into_iter().map(|(input, noise)| one_input(input, noise, peers)).collect()
}

fn one_input(input: &str, noise: f64, peers: &Peers) -> Result<Group, String> {
    let model = built_in("zx30u-arm").map_err(|error| error.to_string())?;
    let signals = signals(&model, noise)?;
    let reference = other(&model, &signals, Method::Bdf, 1e-9)?;
    let (seconds, states) = best_of(REPETITIONS, || ours(&model, &signals, false));
    let error = distance(&model, &states?, &reference);
    let (with_sensitivities, states) = best_of(REPETITIONS, || ours(&model, &signals, true));
    states?;
    let wanted = model.unknown_parameters().len() + System::new(&model).layout().len;
    let mut runs = vec![
        Run::timed("excavator-model", seconds, pascals(error)),
        Run::timed(
            format!("excavator-model with {wanted} sensitivities"),
            with_sensitivities,
            format!("{:.2} of a simulation for each", (with_sensitivities / seconds - 1.0) / wanted as f64),
        ),
    ];
    for method in [Method::Bdf, Method::TrBdf2, Method::Esdirk34] {
        runs.push(as_exact(&model, &signals, method, error, &reference));
    }
    let order = order(&model, &signals, error, &reference)?;
    runs.push(peers.run("SciPy LSODA, right-hand side in Python", "lsoda", &order));
    Ok(Group {
        name: format!("Simulating 38 s at 1 kHz, {input}"),
        what: "The arm of [A]; every other solver runs at the coarsest tolerance at which it is as exact as excavator-model.".into(),
        result: "rms error of the pressures".into(),
        runs,
    })
}

fn pascals(error: f64) -> String {
    format!("{error:.0} Pa")
}

fn area(time: f64) -> f64 {
    if time < 24.0 {
        return 1e-4 * (std::f64::consts::TAU * 0.5 * time).sin();
    }
    let (into, count) = ((time - 24.0) % 3.5, ((time - 24.0) / 3.5) as usize);
    let height = (into / 0.5).min((3.0 - into) / 0.5).clamp(0.0, 1.0);
    6e-5 * height * if count.is_multiple_of(2) { 1.0 } else { -1.0 }
}

fn signals(model: &Model, noise: f64) -> Result<InputSignals, String> {
    let mut recording = common::driven(model, DURATION, INTERVAL, |_, time| area(time), |_| 0.0);
    let mut random = common::Random(7);
    for area in recording.cylinders.iter_mut().flat_map(|cylinder| &mut cylinder.orifice_area) {
        *area += noise * random.normal();
    }
    InputSignals::from_recording(model, &recording).map_err(|error| error.to_string())
}

/// The states at all samples; with sensitivities to all unknown parameters and initial states if asked.
fn ours(model: &Model, signals: &InputSignals, with_sensitivities: bool) -> Result<Vec<Vec<f64>>, String> {
    let system = System::new(model);
    let wanted = if with_sensitivities { model.unknown_parameters() } else { Vec::new() };
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &wanted, Tolerances::default());
    let mut state = common::at_rest(&system);
    let mut states = Vec::with_capacity(signals.len());
    if !with_sensitivities {
        integrator
            .follow(signals, &mut state, |_, state| states.push(state.to_vec()))
            .map_err(|error| error.to_string())?;
        return Ok(states);
    }
    let mut sensitivity = Sensitivity::at_start(&system, &wanted);
    states.push(state.clone());
    for index in 0..signals.len() - 1 {
        integrator.advance(signals, index, &mut state, Some(&mut sensitivity)).map_err(|error| error.to_string())?;
        states.push(state.clone());
    }
    Ok(states)
}

/// Root mean square distance of the pressures of two trajectories, Pa.
fn distance(model: &Model, a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let first = 2 * System::new(model).layout().joints;
    let squares = a.iter().zip(b).flat_map(|(a, b)| a[first..].iter().zip(&b[first..]).map(|(a, b)| (a - b).powi(2)));
    (squares.sum::<f64>() / (a.len() * (a[0].len() - first)) as f64).sqrt()
}

fn other(model: &Model, signals: &InputSignals, method: Method, tolerance: f64) -> Result<Vec<Vec<f64>>, String> {
    solve(model, signals, &common::at_rest(&System::new(model)), method, tolerance)
}

/// diffsol at the coarsest tolerance at which its error is at most `error`.
fn as_exact(model: &Model, signals: &InputSignals, method: Method, error: f64, reference: &[Vec<f64>]) -> Run {
    let name = format!("diffsol {method:?}");
    let mut reason = "not as exact at any tolerance tried".to_string();
    for tolerance in TOLERANCES {
        let begin = Instant::now();
        match other(model, signals, method, tolerance) {
            Ok(states) => {
                let (seconds, their_error) = (begin.elapsed().as_secs_f64(), distance(model, &states, reference));
                if their_error <= error {
                    // Once more without a cold start.
                    let (again, _) = best_of(2, || other(model, signals, method, tolerance));
                    return Run::timed(name, seconds.min(again), format!("{} at {tolerance:e}", pascals(their_error)));
                }
            }
            Err(complaint) => reason = format!("gave up at {tolerance:e}: {complaint}"),
        }
    }
    Run::untimed(name, reason)
}

/// What LSODA in Python needs: numbers of the model, inputs, start and the reference.
fn order(
    model: &Model,
    signals: &InputSignals,
    error: f64,
    reference: &[Vec<f64>],
) -> Result<serde_json::Value, String> {
    let named = model.parameter_names().into_iter().zip(model.parameter_values());
    let values: serde_json::Map<String, serde_json::Value> =
        named.map(|(name, value)| (name.to_string(), json!(value))).collect();
    Ok(json!({
        "model": to_text(model).map_err(|error| error.to_string())?,
        "parameters": values,
        "time": signals.time,
        "area": signals.orifice_area(0),
        "start": common::at_rest(&System::new(model)),
        "error": error,
        "tolerances": TOLERANCES,
        "reference": reference,
    }))
}
