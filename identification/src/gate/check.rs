//! All that is asked of a recording.

use excavator_model::Model;
use excavator_model::machine::{Chambers, Supply};
use excavator_model::recording::{CylinderSignals, Recording, is_measured, noise_level};

use super::GateError;
use super::clipped::clipped;
use super::error::{FEWEST_SAMPLES, SHORTEST};
use super::runs::range;
use super::stuck::{never_changes, stuck_position, stuck_pressure};
use super::swapped::swapped_chambers;

/// A signal must move over this many times its noise to say something of dynamics.
const LEAST_MOTION: f64 = 20.0;

/// Largest hydraulic pressure in use, Pa (gauge): mobile machines stay under 50 MPa.
const HIGHEST_PRESSURE: f64 = 1e8;

/// What a pressure reaches that is measured in Pa, even if only by its noise; 30 is what 3 MPa are in bar.
const LEAST_PRESSURE: f64 = 1e3;

/// What the higher of a cylinder's pressures reaches where it moves anything, and the pump's where it feeds that, Pa: 0.2 bar moves
/// not even a seal; 3000 is what 3 MPa are in kPa.
const LEAST_WORKING_PRESSURE: f64 = 2e4;

/// Checks that `recording` can be used with `model`.
///
/// # Errors
/// [`GateError`], the first thing that is wrong.
pub fn check(model: &Model, recording: &Recording) -> Result<(), GateError> {
    recording.validate()?;
    let machine = &model.machine;
    let time_scale = machine.size().time();
    let needed = SHORTEST * time_scale;
    if recording.duration() < needed || recording.len() < FEWEST_SAMPLES {
        return Err(GateError::TooShort {
            source_name: recording.source.clone(),
            duration: recording.duration(),
            samples: recording.len(),
            needed,
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
        at_most(model, recording, &name("displacement"), &signals.displacement, "m", 2.0 * cylinder.stroke)?;
        within_stroke(model, recording, &name("displacement"), &signals.displacement, cylinder.stroke)?;
        if let Some(chambers) = &cylinder.chambers {
            let limit = 3.0 * chambers.maximum_orifice_area;
            at_most(model, recording, &name("orifice_area"), &signals.orifice_area, "m2", limit)?;
            at_most(model, recording, &name("orifice_command"), &signals.orifice_command, "m2", limit)?;
            for (signal, values) in [("cap_pressure", &signals.cap_pressure), ("rod_pressure", &signals.rod_pressure)] {
                pressure(model, recording, &name(signal), values, LEAST_PRESSURE)?;
            }
            // Of one side alone nobody knows whether it is the one that works.
            if is_measured(&signals.cap_pressure) && is_measured(&signals.rod_pressure) {
                let cap_works = usual_size(&signals.cap_pressure) > usual_size(&signals.rod_pressure);
                let (signal, working) = if cap_works {
                    ("cap_pressure", &signals.cap_pressure)
                } else {
                    ("rod_pressure", &signals.rod_pressure)
                };
                pressure(model, recording, &name(signal), working, LEAST_WORKING_PRESSURE)?;
            }
            let opening =
                if is_measured(&signals.orifice_area) { &signals.orifice_area } else { &signals.orifice_command };
            let correlation = travel_by_opening(&recording.time, &signals.displacement, opening, time_scale);
            if correlation < AGAINST_THE_VALVE {
                return Err(GateError::WrongSign {
                    source_name: recording.source.clone(),
                    cylinder: cylinder.name.clone(),
                    correlation,
                });
            }
            sensors_of_a_cylinder(recording, signals, opening, chambers, time_scale)?;
        } else {
            at_most(model, recording, &name("rod_force"), &signals.rod_force, "N", 1e8)?;
            if let Some(stretch) = never_changes(&recording.time, &signals.rod_force, &signals.displacement, time_scale)
            {
                return Err(stretch.error(recording, name("rod_force"), "N"));
            }
            if cylinder.imposed_motion.is_some() {
                pressure(model, recording, &name("cap_pressure"), &signals.cap_pressure, LEAST_PRESSURE)?;
                pressure(model, recording, &name("rod_pressure"), &signals.rod_pressure, LEAST_PRESSURE)?;
            }
        }
    }
    if machine.has_chambers() {
        pressure(model, recording, "pump_pressure", &recording.pump_pressure, LEAST_WORKING_PRESSURE)?;
        at_most(model, recording, "tank_pressure", &recording.tank_pressure, "Pa", HIGHEST_PRESSURE)?;
        at_most(model, recording, "pump_flow", &recording.pump_flow, "m3/s", 0.1)?;
    }
    if matches!(machine.supply, Supply::PumpLine(_)) {
        let witnesses: Vec<&[f64]> = recording
            .cylinders
            .iter()
            .filter(|signals| machine.cylinders.iter().any(|cylinder| cylinder.name == signals.name))
            .flat_map(|signals| [&signals.cap_pressure[..], &signals.rod_pressure])
            .collect();
        pressure_sensor(recording, "pump_pressure", &recording.pump_pressure, &witnesses, time_scale)?;
    }
    Ok(())
}

/// Sensors that are stuck, cut off or swapped.
fn sensors_of_a_cylinder(
    recording: &Recording,
    signals: &CylinderSignals,
    opening: &[f64],
    chambers: &Chambers,
    time_scale: f64,
) -> Result<(), GateError> {
    let name = |signal: &str| format!("{}.{signal}", signals.name);
    let (cap, rod, displacement) = (&signals.cap_pressure[..], &signals.rod_pressure[..], &signals.displacement[..]);
    if is_measured(cap) && is_the_same(cap, rod) {
        return Err(GateError::SameSignal {
            source_name: recording.source.clone(),
            signals: [name("cap_pressure"), name("rod_pressure")],
        });
    }
    pressure_sensor(recording, &name("cap_pressure"), cap, &[rod, displacement], time_scale)?;
    pressure_sensor(recording, &name("rod_pressure"), rod, &[cap, displacement], time_scale)?;
    if let Some(stretch) = stuck_position(&recording.time, displacement, opening, &[cap, rod], time_scale) {
        return Err(stretch.error(recording, name("displacement"), "m"));
    }
    if let Some(shares) = swapped_chambers(recording, signals, opening, chambers, time_scale) {
        return Err(GateError::SwappedChambers {
            source_name: recording.source.clone(),
            cylinder: signals.name.clone(),
            given: 100.0 * shares.given,
            swapped: 100.0 * shares.swapped,
        });
    }
    Ok(())
}

/// Whether two signals that move are one, reading for reading.
fn is_the_same(one: &[f64], other: &[f64]) -> bool {
    let (low, high) = range(one);
    high > low && one.iter().zip(other).all(|(a, b)| a == b || a.is_nan() && b.is_nan())
}

fn pressure_sensor(
    recording: &Recording,
    name: &str,
    signal: &[f64],
    witnesses: &[&[f64]],
    time_scale: f64,
) -> Result<(), GateError> {
    if let Some(stretch) = stuck_pressure(&recording.time, signal, witnesses, time_scale) {
        return Err(stretch.error(recording, name.to_string(), "Pa"));
    }
    match clipped(&recording.time, signal) {
        Some(cut) => Err(GateError::Clipped {
            source_name: recording.source.clone(),
            signal: name.to_string(),
            value: cut.value,
            longest: cut.longest,
            share: 100.0 * cut.share,
        }),
        None => Ok(()),
    }
}

/// Correlation of travel with opening below which a sign must be wrong: a load may move a piston against its valve now and
/// then, not most of the time.
const AGAINST_THE_VALVE: f64 = -0.5;

/// Time over which travel is taken, s: longer than valves and oil take to follow.
const TRAVEL_TIME: f64 = 0.2;

/// Correlation of the piston's travel over [`TRAVEL_TIME`] with the mean opening meanwhile; zero where there is none.
fn travel_by_opening(time: &[f64], displacement: &[f64], opening: &[f64], time_scale: f64) -> f64 {
    let (mut first, mut sums, mut count) = (0, [0.0; 3], 0usize);
    while let Some(&start) = time.get(first) {
        let last = time.partition_point(|&t| t < start + TRAVEL_TIME * time_scale);
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

/// A robust largest size: single spikes are for the noise model, not for the units.
pub(super) fn usual_size(signal: &[f64]) -> Option<f64> {
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

/// Part of the stroke that a piston may seem to be beyond its ends: an offset of the sensor, and what stops give.
const BEYOND_THE_END: f64 = 0.1;

/// Another zero than mid-stroke makes chambers of impossible volumes, and a simulation that cannot go on.
fn within_stroke(
    model: &Model,
    recording: &Recording,
    name: &str,
    signal: &[f64],
    stroke: f64,
) -> Result<(), GateError> {
    match usual_size(signal) {
        Some(size) if size > (0.5 + BEYOND_THE_END) * stroke => {
            let (from, to) = range(signal);
            Err(GateError::BeyondStroke {
                source_name: recording.source.clone(),
                signal: name.to_string(),
                from,
                to,
                half: 0.5 * stroke,
                machine: model.machine.name.clone(),
            })
        }
        _ => Ok(()),
    }
}

fn pressure(model: &Model, recording: &Recording, name: &str, signal: &[f64], least: f64) -> Result<(), GateError> {
    at_most(model, recording, name, signal, "Pa", HIGHEST_PRESSURE)?;
    match usual_size(signal) {
        // Zero throughout is no measurement in another unit but a side that is open to the air, given as a constant.
        Some(value) if value < least && value > 0.0 => Err(GateError::TooSmall {
            source_name: recording.source.clone(),
            signal: name.to_string(),
            value,
            unit: "Pa",
        }),
        _ => Ok(()),
    }
}
