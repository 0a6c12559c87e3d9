//! Runs all checks of a recording.

use excavator_model::Model;
use excavator_model::machine::{Chambers, Cylinder, Supply};
use excavator_model::recording::{CylinderSignals, Recording, is_measured, noise_level};

use super::CheckError;
use super::clipped::clipped;
use super::error::{FEWEST_SAMPLES, SHORTEST};
use super::runs::range;
use super::stuck::{never_changes, stuck_position, stuck_pressure};
use super::swapped::swapped_chambers;
use super::swapped_forces::swapped_by_force;

/// Factor over its noise by which a signal must move to contain information on dynamics.
const LEAST_MOTION: f64 = 20.0;

/// Largest hydraulic pressure in use, Pa (gauge): mobile machines stay under 50 MPa.
pub(super) const HIGHEST_PRESSURE: f64 = 1e8;

/// Largest force of a cylinder, N.
pub(super) const LARGEST_FORCE: f64 = 1e8;

/// Largest flow of a pump, m³/s.
pub(super) const LARGEST_FLOW: f64 = 0.1;

/// Factor over the stroke that no displacement exceeds, whatever the zero of its sensor.
pub(super) const STROKES: f64 = 2.0;

/// Factor over the full command that no input exceeds.
pub(super) const FULL_COMMANDS: f64 = 3.0;

/// Least value, Pa, that a pressure in Pa reaches, even if only by its noise. 3 MPa in bar are 30.
const LEAST_PRESSURE: f64 = 1e3;

/// Least value, Pa, of the higher of a cylinder's pressures when it moves anything, and of the pump pressure that feeds it.
/// 0.2 bar does not move even a seal; 3 MPa in kPa are 3000.
const LEAST_WORKING_PRESSURE: f64 = 2e4;

/// Checks that `recording` can be used with `model`. A refusal whose name ([`CheckError::name`]) is in `accepted` is overruled.
/// Returns the overruled refusals.
///
/// # Errors
/// [`CheckError`], the first one that is not overruled.
pub fn check(model: &Model, recording: &Recording, accepted: &[String]) -> Result<Vec<CheckError>, CheckError> {
    recording.validate()?;
    let time_scale = model.machine.size().time();
    let mut checks = Checks { model, recording, time_scale, accepted, overruled: Vec::new() };
    checks.length()?;
    for cylinder in &model.machine.cylinders {
        checks.cylinder(cylinder, recording.cylinder(&cylinder.name)?)?;
    }
    checks.supply()?;
    Ok(checks.overruled)
}

struct Checks<'a> {
    model: &'a Model,
    recording: &'a Recording,
    /// The machine's unit of time relative to that of the reference.
    time_scale: f64,
    accepted: &'a [String],
    overruled: Vec<CheckError>,
}

impl Checks<'_> {
    fn refuse(&mut self, error: CheckError) -> Result<(), CheckError> {
        if error.name().is_some_and(|name| self.accepted.iter().any(|accepted| accepted == name)) {
            self.overruled.push(error);
            return Ok(());
        }
        Err(error)
    }

    fn source(&self) -> String {
        self.recording.source.clone()
    }

    fn length(&mut self) -> Result<(), CheckError> {
        let (duration, samples) = (self.recording.duration(), self.recording.len());
        let needed = SHORTEST * self.time_scale;
        if duration >= needed && samples >= FEWEST_SAMPLES {
            return Ok(());
        }
        self.refuse(CheckError::TooShort { source_name: self.source(), duration, samples, needed })
    }

    fn cylinder(&mut self, cylinder: &Cylinder, signals: &CylinderSignals) -> Result<(), CheckError> {
        let name = |signal: &str| format!("{}.{signal}", cylinder.name);
        self.motion(cylinder, signals)?;
        self.at_most(&name("displacement"), &signals.displacement, "m", STROKES * cylinder.stroke)?;
        self.within_stroke(&name("displacement"), &signals.displacement, cylinder.stroke)?;
        if let Some(chambers) = &cylinder.chambers {
            return self.chambers(signals, chambers);
        }
        self.at_most(&name("rod_force"), &signals.rod_force, "N", LARGEST_FORCE)?;
        let time = &self.recording.time;
        if let Some(stretch) = never_changes(time, &signals.rod_force, &signals.displacement, self.time_scale) {
            self.refuse(stretch.error(self.recording, name("rod_force"), "N"))?;
        }
        if cylinder.imposed_motion.is_some() {
            self.pressure(&name("cap_pressure"), &signals.cap_pressure, LEAST_PRESSURE)?;
            self.pressure(&name("rod_pressure"), &signals.rod_pressure, LEAST_PRESSURE)?;
        }
        Ok(())
    }

    fn motion(&mut self, cylinder: &Cylinder, signals: &CylinderSignals) -> Result<(), CheckError> {
        let name = |signal: &str| format!("{}.{signal}", cylinder.name);
        let is_position = is_measured(&signals.displacement);
        let position = if is_position { &signals.displacement } else { &signals.joint_angle };
        if !is_measured(position) {
            return Err(CheckError::NotMeasured {
                source_name: self.source(),
                signal: name("displacement"),
                samples: self.recording.len(),
                machine: self.model.machine.name.clone(),
            });
        }
        let (low, high) = range(position);
        let noise = noise_level(position);
        if high - low > LEAST_MOTION * noise && high - low >= 1e-6 {
            return Ok(());
        }
        self.refuse(CheckError::NoMotion {
            source_name: self.source(),
            signal: name(if is_position { "displacement" } else { "joint_angle" }),
            range: high - low,
            unit: if is_position { "m" } else { "rad" },
            times: if noise > 0.0 { (high - low) / noise } else { 0.0 },
            noise,
        })
    }

    fn chambers(&mut self, signals: &CylinderSignals, chambers: &Chambers) -> Result<(), CheckError> {
        let name = |signal: &str| format!("{}.{signal}", signals.name);
        let limit = FULL_COMMANDS * chambers.full_command();
        let unit = chambers.drive.command_unit().text();
        self.at_most(&name("orifice_area"), &signals.orifice_area, unit, limit)?;
        self.at_most(&name("orifice_command"), &signals.orifice_command, unit, limit)?;
        for (signal, values) in [("cap_pressure", &signals.cap_pressure), ("rod_pressure", &signals.rod_pressure)] {
            self.pressure(&name(signal), values, LEAST_PRESSURE)?;
        }
        // With one side alone, it is unknown whether that side carries the load.
        if is_measured(&signals.cap_pressure) && is_measured(&signals.rod_pressure) {
            let cap_works = usual_size(&signals.cap_pressure) > usual_size(&signals.rod_pressure);
            let (signal, working) = if cap_works {
                ("cap_pressure", &signals.cap_pressure)
            } else {
                ("rod_pressure", &signals.rod_pressure)
            };
            self.pressure(&name(signal), working, LEAST_WORKING_PRESSURE)?;
        }
        let opening = if is_measured(&signals.orifice_area) { &signals.orifice_area } else { &signals.orifice_command };
        let correlation = travel_by_opening(&self.recording.time, &signals.displacement, opening, self.time_scale);
        if correlation < AGAINST_THE_VALVE {
            self.refuse(CheckError::WrongSign {
                source_name: self.source(),
                cylinder: signals.name.clone(),
                correlation,
            })?;
        }
        self.sensors(signals, opening, chambers)
    }

    /// Checks for sensors that are stuck, clipped or swapped.
    fn sensors(&mut self, signals: &CylinderSignals, opening: &[f64], chambers: &Chambers) -> Result<(), CheckError> {
        let name = |signal: &str| format!("{}.{signal}", signals.name);
        let (cap, rod) = (&signals.cap_pressure[..], &signals.rod_pressure[..]);
        let displacement = &signals.displacement[..];
        if is_measured(cap) && is_the_same(cap, rod) {
            self.refuse(CheckError::SameSignal {
                source_name: self.source(),
                signals: [name("cap_pressure"), name("rod_pressure")],
            })?;
        }
        self.pressure_sensor(&name("cap_pressure"), cap, &[rod, displacement])?;
        self.pressure_sensor(&name("rod_pressure"), rod, &[cap, displacement])?;
        let time = &self.recording.time;
        if let Some(stretch) = stuck_position(time, displacement, opening, &[cap, rod], self.time_scale) {
            self.refuse(stretch.error(self.recording, name("displacement"), "m"))?;
        }
        let by_flow = swapped_chambers(self.recording, signals, opening, chambers, self.time_scale);
        let by_force = || swapped_by_force(time, signals, chambers, self.time_scale);
        let found =
            by_flow.map(|shares| ("flow", shares)).or_else(|| by_force().map(|shares| ("pressure force", shares)));
        if let Some((what, shares)) = found {
            self.refuse(CheckError::SwappedChambers {
                source_name: self.source(),
                cylinder: signals.name.clone(),
                what,
                given: 100.0 * shares.given,
                swapped: 100.0 * shares.swapped,
            })?;
        }
        Ok(())
    }

    fn supply(&mut self) -> Result<(), CheckError> {
        let (machine, recording) = (&self.model.machine, self.recording);
        if machine.has_chambers() {
            self.pressure("pump_pressure", &recording.pump_pressure, LEAST_WORKING_PRESSURE)?;
            self.at_most("tank_pressure", &recording.tank_pressure, "Pa", HIGHEST_PRESSURE)?;
            self.at_most("pump_flow", &recording.pump_flow, "m3/s", LARGEST_FLOW)?;
        }
        if matches!(machine.supply, Supply::PumpLine(_)) {
            let witnesses: Vec<&[f64]> = recording
                .cylinders
                .iter()
                .filter(|signals| machine.cylinders.iter().any(|cylinder| cylinder.name == signals.name))
                .flat_map(|signals| [&signals.cap_pressure[..], &signals.rod_pressure])
                .collect();
            self.pressure_sensor("pump_pressure", &recording.pump_pressure, &witnesses)?;
        }
        Ok(())
    }

    fn pressure_sensor(&mut self, name: &str, signal: &[f64], witnesses: &[&[f64]]) -> Result<(), CheckError> {
        if let Some(stretch) = stuck_pressure(&self.recording.time, signal, witnesses, self.time_scale) {
            self.refuse(stretch.error(self.recording, name.to_string(), "Pa"))?;
        }
        let Some(cut) = clipped(&self.recording.time, signal) else { return Ok(()) };
        self.refuse(CheckError::Clipped {
            source_name: self.source(),
            signal: name.to_string(),
            value: cut.value,
            longest: cut.longest,
            share: 100.0 * cut.share,
        })
    }

    fn at_most(&mut self, name: &str, signal: &[f64], unit: &'static str, limit: f64) -> Result<(), CheckError> {
        let Some(value) = usual_size(signal).filter(|value| *value > limit) else { return Ok(()) };
        self.refuse(CheckError::ImpossibleValue {
            source_name: self.source(),
            signal: name.to_string(),
            value,
            unit,
            limit,
            machine: self.model.machine.name.clone(),
        })
    }

    /// A zero point other than mid-stroke gives impossible chamber volumes, and the simulation fails.
    fn within_stroke(&mut self, name: &str, signal: &[f64], stroke: f64) -> Result<(), CheckError> {
        if usual_size(signal).is_none_or(|size| size <= (0.5 + BEYOND_THE_END) * stroke) {
            return Ok(());
        }
        let (from, to) = range(signal);
        self.refuse(CheckError::BeyondStroke {
            source_name: self.source(),
            signal: name.to_string(),
            from,
            to,
            half: 0.5 * stroke,
            machine: self.model.machine.name.clone(),
        })
    }

    fn pressure(&mut self, name: &str, signal: &[f64], least: f64) -> Result<(), CheckError> {
        self.at_most(name, signal, "Pa", HIGHEST_PRESSURE)?;
        match usual_size(signal) {
            // Zero throughout is not a wrong unit: the side is open to the atmosphere, and its pressure is a constant.
            Some(value) if value < least && value > 0.0 => self.refuse(CheckError::TooSmall {
                source_name: self.source(),
                signal: name.to_string(),
                value,
                unit: "Pa",
            }),
            _ => Ok(()),
        }
    }
}

/// Whether two moving signals are identical, reading for reading.
fn is_the_same(one: &[f64], other: &[f64]) -> bool {
    let (low, high) = range(one);
    high > low && one.iter().zip(other).all(|(a, b)| a == b || a.is_nan() && b.is_nan())
}

/// Correlation of travel with opening below which a sign must be wrong. A load may move a piston against its valve at times, but
/// not mostly.
const AGAINST_THE_VALVE: f64 = -0.5;

/// Time over which travel is measured, s: longer than the response of valves and oil.
const TRAVEL_TIME: f64 = 0.2;

/// Correlation of the piston's travel over [`TRAVEL_TIME`] with the mean opening in that time; zero if it is undefined.
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

/// Share of the stroke by which a piston may seem to pass its ends: sensor offset and compliance of the stops.
const BEYOND_THE_END: f64 = 0.1;

/// A robust largest magnitude, insensitive to single spikes: they concern the noise model, not the units.
pub(super) fn usual_size(signal: &[f64]) -> Option<f64> {
    let mut sizes: Vec<f64> = signal.iter().filter(|value| value.is_finite()).map(|value| value.abs()).collect();
    let position = (sizes.len().checked_sub(1)? as f64 * 0.99) as usize;
    Some(*sizes.select_nth_unstable_by(position, f64::total_cmp).1)
}
