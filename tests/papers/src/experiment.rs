//! The experiment of \[A\] in simulation: machine, sine, instruments.

use excavator_model::Model;
use excavator_model::document::built_in;
use excavator_model::effects::{Catalogue, Site};
use excavator_model::recording::Recording;
use excavator_model::simulation::{Tolerances, simulate_from_rest};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// Seeds of the instruments' noise wherever it matters.
pub const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];

/// Samples per second.
const RATE: f64 = 500.0;

/// Amplitude of the sine, m².
const AMPLITUDE: f64 = 1e-4;

/// Noise of displacement (m) and opening (m²).
const DISPLACEMENT_NOISE: f64 = 5e-5;
const OPENING_NOISE: f64 = 2e-7;

/// The arm of \[A\] with the values of its Table 2.
pub fn nominal() -> Result<Model, String> {
    built_in("zx30u-arm").map_err(|error| error.to_string())
}

/// The same with unknown parameters that are off by up to `spread`.
pub fn off_by(spread: f64) -> Result<Model, String> {
    let mut model = nominal()?;
    for (number, parameter) in model.parameters_mut().filter(|parameter| !parameter.known).enumerate() {
        parameter.value *= 1.0 + spread * (1.7 * number as f64 + 0.4).sin();
    }
    Ok(model)
}

/// `model` with one more effect at its cylinder.
pub fn with(model: &Model, effect: &str, values: &[f64]) -> Result<Model, String> {
    let physics = Catalogue::built_in().find(effect).map_err(|error| error.to_string())?;
    let mut model = model.with_effect(&physics, Site::Cylinder(0)).map_err(|error| error.to_string())?;
    let parameters = model.effects.iter_mut().filter(|own| own.name() == effect).flat_map(|own| &mut own.parameters);
    parameters.zip(values).for_each(|(parameter, value)| parameter.value = *value);
    Ok(model)
}

/// How the arm is moved.
#[derive(Debug, Clone, Copy)]
pub struct Sine {
    /// Hz.
    pub frequency: f64,
    /// Displacement at rest before it, m.
    pub start: f64,
    /// s.
    pub duration: f64,
    /// Pressure of the tank, Pa.
    pub tank: f64,
}

impl Sine {
    /// What happens on `model`.
    pub fn on(self, model: &Model) -> Result<Recording, String> {
        let samples = (self.duration * RATE) as usize;
        let mut recording =
            Recording::unmeasured("sine", (0..samples).map(|index| index as f64 / RATE).collect(), &["arm"]);
        recording.tank_pressure.fill(self.tank);
        recording.pump_flow.fill(3.8e-4);
        let area = |t: &f64| AMPLITUDE * (std::f64::consts::TAU * self.frequency * t).sin();
        recording.cylinders[0].orifice_area = recording.time.iter().map(area).collect();
        simulate_from_rest(model, &recording, &[self.start], Tolerances::default().scaled(0.05))
            .map_err(|error| error.to_string())
    }
}

/// What the instruments of the bench of \[B\] read, with noise of 20 µm, 2 kPa and 0.1 mm².
pub fn noisy(recording: &Recording, seed: u64) -> Recording {
    read_with(recording, [2e-5, 2e3, 1e-7], seed)
}

/// What instruments read of the sine, with noise of `pressure` (Pa).
pub fn read(recording: &Recording, pressure: f64, seed: u64) -> Recording {
    read_with(recording, [DISPLACEMENT_NOISE, pressure, OPENING_NOISE], seed)
}

/// With noise of displacement (m), pressures (Pa) and opening (m²). A supply whose pressure is given has none.
fn read_with(recording: &Recording, [displacement, pressure, opening]: [f64; 3], seed: u64) -> Recording {
    let mut recording = recording.clone();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut add = |signal: &mut [f64], level: f64| {
        for value in signal {
            let normal: f64 = StandardNormal.sample(&mut random);
            *value += level * normal;
        }
    };
    let arm = &mut recording.cylinders[0];
    arm.velocity.fill(f64::NAN);
    arm.joint_angle.fill(f64::NAN);
    arm.rod_force.fill(f64::NAN);
    add(&mut arm.displacement, displacement);
    add(&mut arm.cap_pressure, pressure);
    add(&mut arm.rod_pressure, pressure);
    add(&mut arm.orifice_area, opening);
    if recording.pump_flow.iter().any(|flow| flow.is_finite()) {
        add(&mut recording.pump_pressure, pressure);
    }
    recording
}

/// A number with one decimal below ten and none above; a zero has no sign.
pub fn figure(value: f64, has_sign: bool) -> String {
    let decimals = if value.abs() < 9.95 { 1 } else { 0 };
    let text = if has_sign { format!("{value:+.decimals$}") } else { format!("{value:.decimals$}") };
    let size = text.trim_start_matches(['+', '-']);
    if size.chars().all(|one| matches!(one, '0' | '.')) { size.to_string() } else { text }
}

/// Mean of numbers.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
