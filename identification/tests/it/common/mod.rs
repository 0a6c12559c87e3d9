//! What several tests record.
#![allow(dead_code, clippy::unwrap_used)]

#[path = "../../../../model/tests/it/common/scaled.rs"]
pub mod scaled;

use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The arm swings at two frequencies for 16 s, seen without noise at 500 Hz.
pub fn swing(model: &Model) -> Recording {
    let time: Vec<f64> = (0..8000).map(|index| f64::from(index) * 2e-3).collect();
    let mut recording = Recording::unmeasured("swing", time, &["arm"]);
    recording.tank_pressure.fill(3e5);
    recording.pump_flow.fill(3.8e-4);
    let area = |t: &f64| 5e-5 * (3.1 * t).sin() + 3e-5 * (7.3 * t).sin();
    recording.cylinders[0].orifice_area = recording.time.iter().map(area).collect();
    simulate_from_rest(model, &recording, &[0.1], Tolerances::default().scaled(0.05)).unwrap()
}

/// The arm of `machine` steered by two sines, whose frequencies grow with `tempo` (rad/s), for `duration` s, as good instruments
/// see it at 500 Hz.
pub fn steered(machine: &Model, tempo: f64, duration: f64, seed: u64) -> Recording {
    seen(machine, &steering(tempo, duration), seed)
}

/// The inputs of that arm.
pub fn steering(tempo: f64, duration: f64) -> Recording {
    let time: Vec<f64> = (0..(duration * 500.0) as usize).map(|index| index as f64 / 500.0).collect();
    let mut recording = Recording::unmeasured("steered", time, &["arm"]);
    recording.tank_pressure.fill(6e5);
    recording.pump_flow.fill(3.8e-4);
    let area = |t: f64| 6e-5 * (tempo * t).sin() + 4e-5 * (2.7 * tempo * t).sin();
    recording.cylinders[0].orifice_area = recording.time.iter().map(|&t| area(t)).collect();
    recording
}

/// What the arm of `machine` does with these inputs, as good instruments see it.
pub fn seen(machine: &Model, recording: &Recording, seed: u64) -> Recording {
    let mut seen = simulate_from_rest(machine, recording, &[0.05], Tolerances::default().scaled(0.05)).unwrap();
    seen.cylinders[0].orifice_command = recording.cylinders[0].orifice_area.clone();
    measure(&mut ChaCha8Rng::seed_from_u64(seed), &mut seen);
    seen
}

/// A built-in machine whose unknown parameters are up to `spread` of their size away from the ones of its model.
pub fn off_the_data_sheet(name: &str, spread: f64) -> Model {
    let mut model = built_in(name).unwrap();
    for (number, parameter) in model.parameters_mut().filter(|parameter| !parameter.known).enumerate() {
        parameter.value *= 1.0 + spread * (1.7 * number as f64 + 0.4).sin();
    }
    model
}

/// The model with one more effect that has these values.
pub fn with(model: &Model, effect: &str, site: Site, values: &[f64]) -> Model {
    let mut model = model.with_effect(&Catalogue::built_in().find(effect).unwrap(), site).unwrap();
    for (parameter, value) in model.effects.last_mut().unwrap().parameters.iter_mut().zip(values) {
        parameter.value = *value;
    }
    model
}

/// What good instruments report: displacement, pressures and opening with noise; no speed, angle or force.
pub fn measure(random: &mut ChaCha8Rng, recording: &mut Recording) {
    for cylinder in &mut recording.cylinders {
        cylinder.velocity.fill(f64::NAN);
        cylinder.joint_angle.fill(f64::NAN);
        cylinder.rod_force.fill(f64::NAN);
        add_noise(random, &mut cylinder.displacement, 5e-5);
        add_noise(random, &mut cylinder.cap_pressure, 2e3);
        add_noise(random, &mut cylinder.rod_pressure, 2e3);
        add_noise(random, &mut cylinder.orifice_area, 2e-7);
    }
    add_noise(random, &mut recording.pump_pressure, 2e3);
}

/// White noise of a standard deviation, in the signal's unit.
pub fn add_noise(random: &mut ChaCha8Rng, signal: &mut [f64], level: f64) {
    for value in signal {
        let normal: f64 = StandardNormal.sample(random);
        *value += level * normal;
    }
}
