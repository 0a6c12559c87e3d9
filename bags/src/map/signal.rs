//! The signals of a recording by name.

use std::fmt;
use std::str::FromStr;

use excavator_model::recording::{CylinderSignals, Recording};
use serde::{Deserialize, Serialize};

use super::error::MapError;
use super::unit::Dimension;

/// A signal, whichever cylinder it is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum SignalKind {
    JointAngle,
    Displacement,
    Velocity,
    CapPressure,
    RodPressure,
    OrificeArea,
    RodForce,
    OrificeCommand,
    PumpPressure,
    TankPressure,
    PumpFlow,
    OilTemperature,
}

impl SignalKind {
    /// Every signal, in the order of the messages: first those of a cylinder, then those of the machine.
    pub const ALL: [SignalKind; 12] = [
        SignalKind::JointAngle,
        SignalKind::Displacement,
        SignalKind::Velocity,
        SignalKind::CapPressure,
        SignalKind::RodPressure,
        SignalKind::OrificeArea,
        SignalKind::RodForce,
        SignalKind::OrificeCommand,
        SignalKind::PumpPressure,
        SignalKind::TankPressure,
        SignalKind::PumpFlow,
        SignalKind::OilTemperature,
    ];

    /// The name, as the messages have it.
    pub fn name(self) -> &'static str {
        match self {
            SignalKind::JointAngle => "joint_angle",
            SignalKind::Displacement => "displacement",
            SignalKind::Velocity => "velocity",
            SignalKind::CapPressure => "cap_pressure",
            SignalKind::RodPressure => "rod_pressure",
            SignalKind::OrificeArea => "orifice_area",
            SignalKind::RodForce => "rod_force",
            SignalKind::OrificeCommand => "orifice_command",
            SignalKind::PumpPressure => "pump_pressure",
            SignalKind::TankPressure => "tank_pressure",
            SignalKind::PumpFlow => "pump_flow",
            SignalKind::OilTemperature => "oil_temperature",
        }
    }

    /// Whether each cylinder has its own.
    pub fn is_of_cylinder(self) -> bool {
        self <= SignalKind::OrificeCommand
    }

    /// Whether a number of this dimension is a value of it as it stands. A motor turns where a cylinder moves, and what opens a valve may be
    /// told as a voltage, a current or a share: the model then says so too.
    pub fn takes(self, dimension: Dimension) -> bool {
        dimension == self.dimension()
            || match self {
                SignalKind::Displacement => dimension == Dimension::Angle,
                SignalKind::Velocity => dimension == Dimension::RotationalSpeed,
                SignalKind::OrificeArea | SignalKind::OrificeCommand => {
                    matches!(dimension, Dimension::Voltage | Dimension::Current | Dimension::Number | Dimension::Flow)
                }
                _ => false,
            }
    }

    /// What it measures.
    pub fn dimension(self) -> Dimension {
        match self {
            SignalKind::JointAngle => Dimension::Angle,
            SignalKind::Displacement => Dimension::Length,
            SignalKind::Velocity => Dimension::Velocity,
            SignalKind::CapPressure | SignalKind::RodPressure => Dimension::Pressure,
            SignalKind::PumpPressure | SignalKind::TankPressure => Dimension::Pressure,
            SignalKind::OrificeArea | SignalKind::OrificeCommand => Dimension::Area,
            SignalKind::RodForce => Dimension::Force,
            SignalKind::PumpFlow => Dimension::Flow,
            SignalKind::OilTemperature => Dimension::Temperature,
        }
    }
}

/// One signal of a recording: `arm.displacement`, `pump_pressure`.
#[derive(Debug, Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct SignalName {
    /// The cylinder, for signals of a cylinder.
    pub cylinder: Option<String>,
    /// Which signal.
    pub kind: SignalKind,
}

impl SignalName {
    /// The column of the recording that the name stands for; a cylinder that is not there yet is added.
    pub fn column<'r>(&self, recording: &'r mut Recording) -> &'r mut Vec<f64> {
        let samples = recording.len();
        let Some(name) = &self.cylinder else {
            return match self.kind {
                SignalKind::PumpPressure => &mut recording.pump_pressure,
                SignalKind::TankPressure => &mut recording.tank_pressure,
                SignalKind::PumpFlow => &mut recording.pump_flow,
                _ => &mut recording.oil_temperature,
            };
        };
        let index = match recording.cylinders.iter().position(|cylinder| cylinder.name == *name) {
            Some(index) => index,
            None => {
                recording.cylinders.push(CylinderSignals::unmeasured(name, samples));
                recording.cylinders.len() - 1
            }
        };
        let cylinder = &mut recording.cylinders[index];
        match self.kind {
            SignalKind::JointAngle => &mut cylinder.joint_angle,
            SignalKind::Displacement => &mut cylinder.displacement,
            SignalKind::Velocity => &mut cylinder.velocity,
            SignalKind::CapPressure => &mut cylinder.cap_pressure,
            SignalKind::RodPressure => &mut cylinder.rod_pressure,
            SignalKind::OrificeArea => &mut cylinder.orifice_area,
            SignalKind::RodForce => &mut cylinder.rod_force,
            _ => &mut cylinder.orifice_command,
        }
    }
}

impl FromStr for SignalName {
    type Err = MapError;

    fn from_str(text: &str) -> Result<Self, MapError> {
        let (cylinder, name) = match text.rsplit_once('.') {
            Some((cylinder, name)) => (Some(cylinder.to_string()), name),
            None => (None, text),
        };
        let kind = SignalKind::ALL.into_iter().find(|kind| kind.name() == name);
        match kind.filter(|kind| kind.is_of_cylinder() == cylinder.as_ref().is_some_and(|name| !name.is_empty())) {
            Some(kind) => Ok(SignalName { cylinder, kind }),
            None => {
                let (of_cylinder, shared): (Vec<_>, Vec<_>) =
                    SignalKind::ALL.into_iter().partition(|kind| kind.is_of_cylinder());
                Err(MapError::UnknownSignal {
                    wanted: text.to_string(),
                    cylinder: of_cylinder.into_iter().map(SignalKind::name).collect(),
                    shared: shared.into_iter().map(SignalKind::name).collect(),
                })
            }
        }
    }
}

impl fmt::Display for SignalName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.cylinder {
            Some(cylinder) => write!(f, "{cylinder}.{}", self.kind.name()),
            None => f.write_str(self.kind.name()),
        }
    }
}

impl TryFrom<String> for SignalName {
    type Error = MapError;

    fn try_from(text: String) -> Result<Self, MapError> {
        text.parse()
    }
}

impl From<SignalName> for String {
    fn from(name: SignalName) -> String {
        name.to_string()
    }
}
