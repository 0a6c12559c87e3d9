//! Length, motion, and units that are wrong by orders of magnitude.

use excavator_model::Model;
use excavator_model::recording::{Recording, is_measured, noise_level};

/// Shortest recording that says anything, s: two swings of the slowest excitation in use.
const SHORTEST: f64 = 2.0;

/// Fewest samples.
const FEWEST_SAMPLES: usize = 100;

/// A signal must move over this many times its noise to say something of dynamics.
const LEAST_MOTION: f64 = 20.0;

/// Largest hydraulic pressure in use, Pa (gauge): mobile machines stay under 50 MPa.
const HIGHEST_PRESSURE: f64 = 1e8;

/// A recording that cannot be used, in one line that says what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum GateError {
    /// Too short.
    #[error(
        "{source_name} is too short: {duration:.2} s with {samples} samples; at least {SHORTEST} s and {FEWEST_SAMPLES} samples are needed"
    )]
    TooShort {
        /// The recording.
        source_name: String,
        /// Its length, s.
        duration: f64,
        /// Its samples.
        samples: usize,
    },
    /// Nothing of a cylinder was measured.
    #[error("{source_name} does not measure {signal} (all {samples} values are NaN), which {machine} needs")]
    NotMeasured {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// Samples.
        samples: usize,
        /// The machine.
        machine: String,
    },
    /// The arm does not move.
    #[error(
        "{source_name} has no motion: {signal} stays within {range:.2e} {unit}, {times:.0} times its noise of {noise:.1e} {unit}; record while the arm moves"
    )]
    NoMotion {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// Largest minus smallest value.
        range: f64,
        /// SI unit.
        unit: &'static str,
        /// Range over noise.
        times: f64,
        /// Noise.
        noise: f64,
    },
    /// A value that cannot be in SI units.
    #[error(
        "{source_name}: {signal} reaches {value:.3e} {unit}, but {machine} allows at most {limit:.3e} {unit}; is it in {unit}?"
    )]
    ImpossibleValue {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The value of largest size.
        value: f64,
        /// SI unit.
        unit: &'static str,
        /// Largest possible size.
        limit: f64,
        /// The machine.
        machine: String,
    },
    /// A signal far too small to be in SI units.
    #[error(
        "{source_name}: {signal} never exceeds {value:.3e} {unit}, far below anything hydraulic; is it in {unit}, not in bar or MPa?"
    )]
    TooSmall {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The value of largest size.
        value: f64,
        /// SI unit.
        unit: &'static str,
    },
    /// The piston moves against its valve.
    #[error(
        "{source_name}: {cylinder} retracts where its valve feeds the cap side and extends where it feeds the rod side (correlation {correlation:.2}); check the signs of displacement and opening"
    )]
    WrongSign {
        /// The recording.
        source_name: String,
        /// The cylinder.
        cylinder: String,
        /// Correlation of piston travel with opening.
        correlation: f64,
    },
    /// The recording has no cylinder of the machine.
    #[error(transparent)]
    Recording(#[from] excavator_model::recording::RecordingError),
}

/// Checks that `recording` can be used with `model`.
///
/// # Errors
/// [`GateError`], the first thing that is wrong.
pub fn check(model: &Model, recording: &Recording) -> Result<(), GateError> {
    recording.validate()?;
    let machine = &model.machine;
    if recording.duration() < SHORTEST || recording.len() < FEWEST_SAMPLES {
        return Err(GateError::TooShort {
            source_name: recording.source.clone(),
            duration: recording.duration(),
            samples: recording.len(),
        });
    }
    for cylinder in &machine.cylinders {
        let signals = recording.cylinder(&cylinder.name)?;
        let name = |signal: &str| format!("{}.{signal}", cylinder.name);
        let position = if is_measured(&signals.displacement) { &signals.displacement } else { &signals.joint_angle };
        if !is_measured(position) {
            return Err(GateError::NotMeasured {
                source_name: recording.source.clone(),
                signal: name("displacement"),
                samples: recording.len(),
                machine: machine.name.clone(),
            });
        }
        let (low, high) = range(position);
        let noise = noise_level(position);
        let unit = if is_measured(&signals.displacement) { "m" } else { "rad" };
        if high - low <= LEAST_MOTION * noise || high - low < 1e-6 {
            return Err(GateError::NoMotion {
                source_name: recording.source.clone(),
                signal: name(if unit == "m" { "displacement" } else { "joint_angle" }),
                range: high - low,
                unit,
                times: if noise > 0.0 { (high - low) / noise } else { 0.0 },
                noise,
            });
        }
        // Twice half the stroke: an offset of the sensor is allowed, another unit is not.
        at_most(model, recording, &name("displacement"), &signals.displacement, "m", cylinder.stroke)?;
        if let Some(chambers) = cylinder.chambers {
            let limit = 3.0 * chambers.maximum_orifice_area;
            at_most(model, recording, &name("orifice_area"), &signals.orifice_area, "m2", limit)?;
            at_most(model, recording, &name("orifice_command"), &signals.orifice_command, "m2", limit)?;
            for (signal, values) in [("cap_pressure", &signals.cap_pressure), ("rod_pressure", &signals.rod_pressure)] {
                pressure(model, recording, &name(signal), values)?;
            }
            let opening =
                if is_measured(&signals.orifice_area) { &signals.orifice_area } else { &signals.orifice_command };
            let correlation = travel_by_opening(&recording.time, &signals.displacement, opening);
            if correlation < AGAINST_THE_VALVE {
                return Err(GateError::WrongSign {
                    source_name: recording.source.clone(),
                    cylinder: cylinder.name.clone(),
                    correlation,
                });
            }
        } else {
            at_most(model, recording, &name("rod_force"), &signals.rod_force, "N", 1e8)?;
            if cylinder.imposed_motion.is_some() {
                pressure(model, recording, &name("cap_pressure"), &signals.cap_pressure)?;
                pressure(model, recording, &name("rod_pressure"), &signals.rod_pressure)?;
            }
        }
    }
    if machine.has_chambers() {
        pressure(model, recording, "pump_pressure", &recording.pump_pressure)?;
        at_most(model, recording, "tank_pressure", &recording.tank_pressure, "Pa", HIGHEST_PRESSURE)?;
        at_most(model, recording, "pump_flow", &recording.pump_flow, "m3/s", 0.1)?;
    }
    Ok(())
}

/// Correlation of travel with opening below which a sign must be wrong: a load may move a piston against its valve now and
/// then, not most of the time.
const AGAINST_THE_VALVE: f64 = -0.5;

/// Time over which travel is taken, s: longer than valves and oil take to follow.
const TRAVEL_TIME: f64 = 0.2;

/// Correlation of the piston's travel over [`TRAVEL_TIME`] with the mean opening meanwhile; zero where there is none.
fn travel_by_opening(time: &[f64], displacement: &[f64], opening: &[f64]) -> f64 {
    let (mut first, mut sums, mut count) = (0, [0.0; 3], 0usize);
    while let Some(&start) = time.get(first) {
        let last = time.partition_point(|&t| t < start + TRAVEL_TIME);
        let Some(&end) = displacement.get(last) else { break };
        let known: Vec<f64> = opening[first..last].iter().copied().filter(|area| area.is_finite()).collect();
        let travel = end - displacement[first];
        if travel.is_finite() && !known.is_empty() {
            let mean = known.iter().sum::<f64>() / known.len() as f64;
            sums = [sums[0] + travel * mean, sums[1] + travel * travel, sums[2] + mean * mean];
            count += 1;
        }
        first = last;
    }
    let size = (sums[1] * sums[2]).sqrt();
    if count >= 10 && size > 0.0 { sums[0] / size } else { 0.0 }
}

fn range(signal: &[f64]) -> (f64, f64) {
    let finite = signal.iter().filter(|value| value.is_finite());
    finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)))
}

/// A robust largest size: single spikes are for the noise model, not for the units.
fn usual_size(signal: &[f64]) -> Option<f64> {
    let mut sizes: Vec<f64> = signal.iter().filter(|value| value.is_finite()).map(|value| value.abs()).collect();
    let position = (sizes.len().checked_sub(1)? as f64 * 0.99) as usize;
    Some(*sizes.select_nth_unstable_by(position, f64::total_cmp).1)
}

fn at_most(
    model: &Model,
    recording: &Recording,
    name: &str,
    signal: &[f64],
    unit: &'static str,
    limit: f64,
) -> Result<(), GateError> {
    match usual_size(signal) {
        Some(value) if value > limit => Err(GateError::ImpossibleValue {
            source_name: recording.source.clone(),
            signal: name.to_string(),
            value,
            unit,
            limit,
            machine: model.machine.name.clone(),
        }),
        _ => Ok(()),
    }
}

fn pressure(model: &Model, recording: &Recording, name: &str, signal: &[f64]) -> Result<(), GateError> {
    at_most(model, recording, name, signal, "Pa", HIGHEST_PRESSURE)?;
    match usual_size(signal) {
        // A working hydraulic pressure is never below 1 kPa all the time; 30 is what 3 MPa are in bar. Zero throughout is
        // no measurement in another unit but a side that is open to the air, given as a constant.
        Some(value) if value < 1e3 && value > 0.0 => Err(GateError::TooSmall {
            source_name: recording.source.clone(),
            signal: name.to_string(),
            value,
            unit: "Pa",
        }),
        _ => Ok(()),
    }
}
