//! Which signals a recording has, and what they are good for.

use excavator_model::recording::{CylinderSignals, Recording, is_measured};
use serde::Serialize;

/// One measured signal.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SignalInfo {
    /// Contract name: `arm.displacement`.
    pub name: String,
    /// Share of the samples without value, 0 to 1.
    pub missing: f64,
    /// Smallest value, SI.
    pub least: f64,
    /// Largest value, SI.
    pub most: f64,
}

/// One equation of the model and the signals that it lacks.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct EquationInfo {
    /// `arm motion`, `arm chambers`, `pump line`.
    pub equation: String,
    /// The signals that must be measured before the equation can be identified; empty when it can.
    pub missing: Vec<String>,
    /// The signals that are not measured and must be constants of the machine then.
    pub constant: Vec<String>,
}

/// What can be identified from a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SignalsInfo {
    /// Samples of the clock.
    pub samples: usize,
    /// Measured signals, in the order of the messages.
    pub measured: Vec<SignalInfo>,
    /// The equations that such a machine has.
    pub equations: Vec<EquationInfo>,
}

impl SignalsInfo {
    /// Looks at every signal of a recording.
    pub fn of(recording: &Recording) -> SignalsInfo {
        let measured = recording.signals().into_iter().filter(|(_, values)| is_measured(values));
        let mut equations: Vec<EquationInfo> = Vec::new();
        for cylinder in &recording.cylinders {
            equations.push(motion(cylinder));
            // A drive of which nothing hydraulic is measured has no chambers as far as anybody can tell.
            if has_oil(cylinder) {
                equations.push(chambers(cylinder, recording));
            }
        }
        if recording.cylinders.iter().any(has_oil) {
            equations.push(pump_line(recording));
        }
        SignalsInfo {
            samples: recording.len(),
            measured: measured.map(|(name, values)| SignalInfo::of(name, values)).collect(),
            equations,
        }
    }
}

impl SignalInfo {
    /// Looks at all values of a signal.
    pub(super) fn of(name: String, values: &[f64]) -> SignalInfo {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        SignalInfo {
            name,
            missing: 1.0 - finite().count() as f64 / values.len().max(1) as f64,
            least: finite().fold(f64::INFINITY, f64::min),
            most: finite().fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

fn has_oil(cylinder: &CylinderSignals) -> bool {
    [&cylinder.cap_pressure, &cylinder.rod_pressure, &cylinder.orifice_area, &cylinder.orifice_command]
        .into_iter()
        .any(|values| is_measured(values))
}

fn position(cylinder: &CylinderSignals, missing: &mut Vec<String>) {
    if !is_measured(&cylinder.displacement) && !is_measured(&cylinder.joint_angle) {
        missing.push(format!("{0}.displacement or {0}.joint_angle", cylinder.name));
    }
}

fn pressures(cylinder: &CylinderSignals, missing: &mut Vec<String>) {
    for (name, values) in [("cap_pressure", &cylinder.cap_pressure), ("rod_pressure", &cylinder.rod_pressure)] {
        if !is_measured(values) {
            missing.push(format!("{}.{name}", cylinder.name));
        }
    }
}

fn opening(cylinder: &CylinderSignals, missing: &mut Vec<String>) {
    if !is_measured(&cylinder.orifice_area) && !is_measured(&cylinder.orifice_command) {
        missing.push(format!("{0}.orifice_area or {0}.orifice_command", cylinder.name));
    }
}

/// Torque or force on what the cylinder moves: from both pressures, or from a load cell alone.
fn motion(cylinder: &CylinderSignals) -> EquationInfo {
    let mut missing = Vec::new();
    position(cylinder, &mut missing);
    if !is_measured(&cylinder.rod_force) {
        pressures(cylinder, &mut missing);
        if !has_oil(cylinder) {
            missing.retain(|name| !name.ends_with("_pressure"));
            missing.push(format!("{0}.rod_force, or {0}.cap_pressure and {0}.rod_pressure", cylinder.name));
        }
    }
    EquationInfo { equation: format!("{} motion", cylinder.name), missing, constant: Vec::new() }
}

/// Continuity of both chambers.
fn chambers(cylinder: &CylinderSignals, recording: &Recording) -> EquationInfo {
    let mut missing = Vec::new();
    position(cylinder, &mut missing);
    pressures(cylinder, &mut missing);
    opening(cylinder, &mut missing);
    let ends = [("pump_pressure", &recording.pump_pressure), ("tank_pressure", &recording.tank_pressure)];
    EquationInfo { equation: format!("{} chambers", cylinder.name), missing, constant: unmeasured(&ends) }
}

/// Continuity of the line between pump and valves.
fn pump_line(recording: &Recording) -> EquationInfo {
    let mut missing = unmeasured(&[("pump_pressure", &recording.pump_pressure)]);
    let constant = unmeasured(&[("tank_pressure", &recording.tank_pressure), ("pump_flow", &recording.pump_flow)]);
    for cylinder in recording.cylinders.iter().filter(|cylinder| has_oil(cylinder)) {
        opening(cylinder, &mut missing);
    }
    EquationInfo { equation: "pump line".to_string(), missing, constant }
}

fn unmeasured(signals: &[(&str, &Vec<f64>)]) -> Vec<String> {
    signals.iter().filter(|(_, values)| !is_measured(values)).map(|(name, _)| name.to_string()).collect()
}
