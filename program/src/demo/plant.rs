//! Runs the simulated machine, and measures it with simulated instruments.

use excavator_model::equations::System;
use excavator_model::recording::Recording;
use excavator_model::simulation::{
    InputSignals, Integrator, Profile, RunError, SimulationError, Tolerances, observed, rest_state,
};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

use super::sealed::Sealed;

/// Samples per second of the recorder.
const RATE: f64 = 500.0;
/// Time constant with which the spool follows its command, s.
const SPOOL_LAG: f64 = 0.012;
/// Tank pressure, Pa.
const TANK_PRESSURE: f64 = 3e5;
/// Gain with which the operator steers the arm back to mid-stroke, m² per m.
const CENTRING: f64 = 8e-5;
/// Noise of the displacement sensor, m.
const DISPLACEMENT_NOISE: f64 = 5e-5;
/// Noise of the pressure sensors, Pa.
const PRESSURE_NOISE: f64 = 2e3;
/// Noise of the spool sensor, m².
const SPOOL_NOISE: f64 = 2e-7;
/// Jitter of the stamps, s.
const JITTER: f64 = 2e-5;
/// Share of messages lost in transport.
const LOSS: f64 = 1e-3;

/// Runs a manoeuvre on the machine and records it.
pub fn record(sealed: &Sealed, profile: &Profile, generator: &mut ChaCha8Rng) -> Result<Recording, RunError> {
    let mut clean = run(sealed, profile)?;
    measure(&mut clean, sealed.has_spool_sensor(), generator);
    Ok(clean)
}

fn run(sealed: &Sealed, profile: &Profile) -> Result<Recording, RunError> {
    let model = &sealed.truth;
    let samples = (profile.duration() * RATE) as usize;
    let time: Vec<f64> = (0..samples).map(|index| index as f64 / RATE).collect();
    let mut recording = Recording::unmeasured(&model.machine.name, time, &["arm"]);
    recording.tank_pressure.fill(TANK_PRESSURE);
    recording.oil_temperature.fill(27.0);
    if let excavator_model::machine::Supply::PumpLine(line) = model.machine.supply {
        recording.pump_flow.fill(line.flow);
    }
    recording.cylinders[0].orifice_area.fill(0.0);
    let mut signals = InputSignals::from_recording(model, &recording)?;
    let system = System::new(model);
    let mut state = rest_state(&system, &[0.0], &signals.at_start());
    // Finer than the tolerances of the identifier, so that it is not tested against its own rounding.
    let tolerances = Tolerances::default().scaled(0.05);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], tolerances);
    let follow = 1.0 - (-1.0 / (RATE * SPOOL_LAG)).exp();
    let mut spool = 0.0;
    for index in 0..samples {
        observed(&system, &state, index, &mut recording);
        let displacement = recording.cylinders[0].displacement[index];
        let wanted = profile.area(recording.time[index]);
        // The operator corrects the drift only while the arm moves, and leaves the valve alone in pauses.
        let correction = if wanted == 0.0 { 0.0 } else { -CENTRING * displacement };
        let command = wanted + correction;
        recording.cylinders[0].orifice_command[index] = command;
        let opening = if sealed.has_spool_sensor() { spool } else { command };
        recording.cylinders[0].orifice_area[index] = opening;
        signals.set_orifice_area(0, index, opening);
        spool += follow * (command - spool);
        if index + 1 < samples {
            let next = if sealed.has_spool_sensor() { spool } else { command };
            signals.set_orifice_area(0, index + 1, next);
            let advanced: Result<(), SimulationError> = integrator.advance(&signals, index, &mut state, None);
            advanced?;
        }
    }
    Ok(recording)
}

/// Adds the errors of instruments: noise, jitter, lost messages. Removes the signals without a sensor.
fn measure(recording: &mut Recording, spool_sensor: bool, generator: &mut ChaCha8Rng) {
    let mut noisy = |values: &mut [f64], deviation: f64| {
        if let Ok(noise) = Normal::new(0.0, deviation) {
            values.iter_mut().for_each(|value| *value += noise.sample(generator));
        }
    };
    let cylinder = &mut recording.cylinders[0];
    noisy(&mut cylinder.displacement, DISPLACEMENT_NOISE);
    noisy(&mut cylinder.cap_pressure, PRESSURE_NOISE);
    noisy(&mut cylinder.rod_pressure, PRESSURE_NOISE);
    noisy(&mut cylinder.orifice_area, SPOOL_NOISE);
    cylinder.velocity.fill(f64::NAN);
    cylinder.joint_angle.fill(f64::NAN);
    if !spool_sensor {
        cylinder.orifice_area.fill(f64::NAN);
    }
    noisy(&mut recording.pump_pressure, PRESSURE_NOISE);
    noisy(&mut recording.tank_pressure, PRESSURE_NOISE);
    let last = recording.len() - 1;
    for (index, time) in recording.time.iter_mut().enumerate() {
        if index > 0 && index < last {
            *time += generator.random_range(-JITTER..JITTER);
        }
    }
    let kept: Vec<bool> = (0..recording.len()).map(|index| index == 0 || generator.random::<f64>() >= LOSS).collect();
    keep(recording, &kept);
}

fn keep(recording: &mut Recording, kept: &[bool]) {
    for values in recording.columns_mut() {
        let mut flags = kept.iter();
        values.retain(|_| flags.next().copied().unwrap_or(true));
    }
}
