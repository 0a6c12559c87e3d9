//! What several tests record.
#![allow(dead_code, clippy::unwrap_used)]

use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
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

/// White noise of a standard deviation, in the signal's unit.
pub fn add_noise(random: &mut ChaCha8Rng, signal: &mut [f64], level: f64) {
    for value in signal {
        let normal: f64 = StandardNormal.sample(random);
        *value += level * normal;
    }
}
