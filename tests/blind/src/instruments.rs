//! What the instruments make of what happened.

use excavator_model::recording::Recording;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::plant::{Extras, PUMP_FLOW, Sensors, TANK_PRESSURE};
use crate::run::{RATE, Truth};

/// Standard deviations of noise and the rest of an instrument's imperfections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instruments {
    /// Factor on all noise, jitter left alone.
    pub noise: f64,
    /// Whether there is a spool sensor.
    pub spool_sensor: bool,
    /// Time by which the spool's samples are taken ahead of all others in the same message, s: buses and converters read
    /// one channel after the other.
    pub spool_lead: f64,
    /// Samples per second, [`RATE`] over a whole number.
    pub rate: f64,
    /// Bits of the converters.
    pub bits: u32,
}

impl Default for Instruments {
    fn default() -> Self {
        Instruments { noise: 1.0, spool_sensor: true, spool_lead: 0.0, rate: RATE, bits: 16 }
    }
}

/// Noise of the displacement sensor, m.
pub const DISPLACEMENT_NOISE: f64 = 5e-5;
/// Noise of the pressure sensors, Pa.
pub const PRESSURE_NOISE: f64 = 2e3;
/// Noise of the spool sensor, m².
pub const SPOOL_NOISE: f64 = 2e-7;
/// Standard deviation of the stamps, s.
const JITTER: f64 = 2e-5;
/// Share of messages lost.
const LOSS: f64 = 1e-3;
/// Ranges of the converters: displacement (m), pressure (Pa), spool (m²).
const RANGES: [f64; 3] = [0.7, 25e6, 4e-4];
/// Stamp of the first sample, ns since the epoch: a made-up day.
const EPOCH: i64 = 1_795_000_000_000_000_000;

/// The recording of a run. `source` names it.
pub fn record(
    truth: &Truth,
    sensors: &Sensors,
    extras: &Extras,
    instruments: &Instruments,
    source: &str,
    generator: &mut ChaCha8Rng,
) -> Recording {
    let samples = truth.samples();
    let stride = ((RATE / instruments.rate).round() as usize).max(1);
    let kept: Vec<usize> = (0..samples)
        .filter(|&sample| sample == 0 || generator.random::<f64>() >= LOSS)
        .filter(|sample| sample % stride == 0)
        .collect();
    let stamps: Vec<f64> = (0..samples)
        .map(|sample| {
            let normal: f64 = StandardNormal.sample(generator);
            sample as f64 / RATE + JITTER * normal.clamp(-5.0, 5.0)
        })
        .collect();
    let first = stamps.first().copied().unwrap_or(0.0);
    let mut seen = |values: Vec<f64>, offset: f64, noise: f64, range: f64| -> Vec<f64> {
        let read: Vec<f64> = values
            .iter()
            .map(|value| {
                let normal: f64 = StandardNormal.sample(generator);
                quantised(value + offset + instruments.noise * noise * normal, range, instruments.bits)
            })
            .collect();
        kept.iter().map(|&sample| read[sample]).collect()
    };
    let [length, pressure, area] = RANGES;
    let late = sensors.pressure_delay;
    let displacement = Truth::late(&truth.displacement, sensors.displacement_delay);
    let displacement = displacement.into_iter().map(|value| sensors.displacement(value)).collect();
    let displacement = seen(displacement, 0.0, DISPLACEMENT_NOISE, length);
    let cap = seen(Truth::late(&truth.cap, late), sensors.cap_offset, PRESSURE_NOISE, pressure);
    let rod = seen(Truth::late(&truth.rod, late), sensors.rod_offset, PRESSURE_NOISE, pressure);
    let pump = seen(Truth::late(&truth.pump, late), sensors.pump_offset, PRESSURE_NOISE, pressure);
    let tank = seen(vec![TANK_PRESSURE; samples], 0.0, PRESSURE_NOISE, pressure);
    let spool = seen(Truth::late(&truth.spool, -instruments.spool_lead), 0.0, SPOOL_NOISE, area);

    let time: Vec<f64> = kept.iter().map(|&sample| stamps[sample] - first).collect();
    let mut recording = Recording::unmeasured(source, time, &["arm"]);
    recording.start_nanoseconds = EPOCH;
    recording.oil_temperature = recording.time.iter().map(|time| extras.temperature + extras.warming * time).collect();
    recording.pump_flow.fill(PUMP_FLOW);
    recording.pump_pressure = pump;
    recording.tank_pressure = tank;
    let cylinder = &mut recording.cylinders[0];
    cylinder.displacement = displacement;
    cylinder.cap_pressure = cap;
    cylinder.rod_pressure = rod;
    cylinder.orifice_command = kept.iter().map(|&sample| truth.command[sample]).collect();
    if instruments.spool_sensor {
        cylinder.orifice_area = spool;
    }
    recording
}

/// The nearest step of a converter with so many bits over `range`.
fn quantised(value: f64, range: f64, bits: u32) -> f64 {
    let step = range / f64::from(bits).exp2();
    (value / step).round() * step
}
