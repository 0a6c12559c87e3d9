//! The newest value of each signal, and whether it can be used.

use std::time::{Duration, Instant};

use excavator_msgs::{ArmState, CylinderState, Header, Time};
use serde::Deserialize;

/// What becomes of the raw value of a signal.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Treatment {
    /// Which signal: `arm.displacement`, `pump_pressure`.
    pub signal: String,
    /// Factor of the raw value.
    #[serde(default = "one")]
    pub scale: f64,
    /// What is added to it then, in SI.
    #[serde(default)]
    pub offset: f64,
    /// Least value that can be, in SI.
    #[serde(default = "lowest")]
    pub minimum: f64,
    /// Largest value that can be, in SI.
    #[serde(default = "highest")]
    pub maximum: f64,
    /// Age beyond which a value is of no use, s.
    #[serde(default = "default_age")]
    pub age: f64,
}

fn one() -> f64 {
    1.0
}

fn lowest() -> f64 {
    f64::NEG_INFINITY
}

fn highest() -> f64 {
    f64::INFINITY
}

/// 0.1 s: ten samples of a slow instrument.
fn default_age() -> f64 {
    0.1
}

const OF_CYLINDERS: [&str; 7] =
    ["joint_angle", "displacement", "velocity", "cap_pressure", "rod_pressure", "orifice_area", "rod_force"];
const OF_MACHINE: [&str; 4] = ["pump_pressure", "tank_pressure", "pump_flow", "oil_temperature"];

impl Treatment {
    /// Whether it makes sense.
    ///
    /// # Errors
    /// What is wrong, in one line.
    pub fn check(&self) -> Result<(), String> {
        let known = match self.signal.split_once('.') {
            Some((cylinder, name)) => !cylinder.is_empty() && OF_CYLINDERS.contains(&name),
            None => OF_MACHINE.contains(&self.signal.as_str()),
        };
        if !known {
            return Err(format!(
                "there is no signal \"{}\"; there are CYLINDER.{} and {}",
                self.signal,
                OF_CYLINDERS.join(", CYLINDER."),
                OF_MACHINE.join(", ")
            ));
        }
        if !self.scale.is_finite() || self.scale == 0.0 || !self.offset.is_finite() {
            return Err(format!("{}: scale {} and offset {} make no value", self.signal, self.scale, self.offset));
        }
        if self.minimum.is_nan() || self.maximum.is_nan() || self.minimum >= self.maximum {
            return Err(format!("{}: nothing is between {} and {}", self.signal, self.minimum, self.maximum));
        }
        if !(self.age > 0.0 && self.age < 1e6) {
            return Err(format!("{}: an age of {} s makes no sense", self.signal, self.age));
        }
        Ok(())
    }
}

/// Why a signal is not measured.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Fault {
    /// No value ever came.
    Never,
    /// The last value is too old, s.
    Stale(f64),
    /// The last value cannot be.
    OutOfRange(f64),
}

/// The newest value of each signal.
#[derive(Debug)]
pub(super) struct Signals {
    treatments: Vec<Treatment>,
    newest: Vec<Option<(f64, Instant)>>,
}

impl Signals {
    /// Signals of which nothing has come.
    pub fn new(treatments: Vec<Treatment>) -> Self {
        let newest = vec![None; treatments.len()];
        Signals { treatments, newest }
    }

    /// Takes a raw value.
    pub fn take(&mut self, index: usize, raw: f64, now: Instant) {
        if let Some(slot) = self.newest.get_mut(index) {
            *slot = Some((raw, now));
        }
    }

    /// The value in SI.
    ///
    /// # Errors
    /// [`Fault`]: it is not measured.
    pub fn value(&self, index: usize, now: Instant) -> Result<f64, Fault> {
        let (treatment, Some((raw, at))) = (&self.treatments[index], self.newest[index]) else {
            return Err(Fault::Never);
        };
        let age = now.saturating_duration_since(at);
        if age > Duration::from_secs_f64(treatment.age) {
            return Err(Fault::Stale(age.as_secs_f64()));
        }
        let value = raw * treatment.scale + treatment.offset;
        if !value.is_finite() || value < treatment.minimum || value > treatment.maximum {
            return Err(Fault::OutOfRange(value));
        }
        Ok(value)
    }

    /// Name of a signal.
    pub fn name(&self, index: usize) -> &str {
        &self.treatments[index].signal
    }

    /// The state at `now`, and what is not measured in it and why.
    pub fn state(&self, stamp: Time, now: Instant) -> (ArmState, Vec<(usize, Fault)>) {
        let mut state = ArmState {
            header: Header { stamp, frame_id: String::new() },
            cylinders: Vec::new(),
            pump_pressure: f64::NAN,
            tank_pressure: f64::NAN,
            pump_flow: f64::NAN,
            oil_temperature: f64::NAN,
        };
        let mut faults = Vec::new();
        for (index, treatment) in self.treatments.iter().enumerate() {
            let value = self.value(index, now).unwrap_or_else(|fault| {
                faults.push((index, fault));
                f64::NAN
            });
            if let Some(slot) = slot(&mut state, &treatment.signal) {
                *slot = value;
            }
        }
        (state, faults)
    }
}

/// Where a signal stands in the message; its cylinder is added when it is new.
fn slot<'s>(state: &'s mut ArmState, signal: &str) -> Option<&'s mut f64> {
    let Some((name, field)) = signal.split_once('.') else {
        return match signal {
            "pump_pressure" => Some(&mut state.pump_pressure),
            "tank_pressure" => Some(&mut state.tank_pressure),
            "pump_flow" => Some(&mut state.pump_flow),
            "oil_temperature" => Some(&mut state.oil_temperature),
            _ => None,
        };
    };
    if !state.cylinders.iter().any(|cylinder| cylinder.name == name) {
        state.cylinders.push(CylinderState::unmeasured(name));
    }
    let cylinder = state.cylinders.iter_mut().find(|cylinder| cylinder.name == name)?;
    match field {
        "joint_angle" => Some(&mut cylinder.joint_angle),
        "displacement" => Some(&mut cylinder.displacement),
        "velocity" => Some(&mut cylinder.velocity),
        "cap_pressure" => Some(&mut cylinder.cap_pressure),
        "rod_pressure" => Some(&mut cylinder.rod_pressure),
        "orifice_area" => Some(&mut cylinder.orifice_area),
        "rod_force" => Some(&mut cylinder.rod_force),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn treatment(signal: &str) -> Treatment {
        Treatment { signal: signal.into(), scale: 1e-3, offset: -0.3, minimum: -0.31, maximum: 0.31, age: 0.05 }
    }

    #[test]
    fn a_value_is_scaled_and_ages() {
        let start = Instant::now();
        let mut signals = Signals::new(vec![treatment("arm.displacement"), treatment("boom.displacement")]);
        signals.take(0, 400.0, start);
        let (state, faults) = signals.state(Time::default(), start);
        assert!((state.cylinders[0].displacement - 0.1).abs() < 1e-12);
        assert_eq!(faults, [(1, Fault::Never)]);
        let later = start + Duration::from_millis(51);
        assert!(matches!(signals.value(0, later), Err(Fault::Stale(age)) if age > 0.05));
        assert!(signals.state(Time::default(), later).0.cylinders[0].displacement.is_nan());
    }

    #[test]
    fn what_cannot_be_is_not_measured() {
        let start = Instant::now();
        let mut signals = Signals::new(vec![treatment("arm.displacement")]);
        for raw in [1e6, f64::NAN, f64::INFINITY] {
            signals.take(0, raw, start);
            assert!(matches!(signals.value(0, start), Err(Fault::OutOfRange(_))), "{raw}");
        }
    }
}
