//! The signals of a recording by name.

use std::fmt;
use std::str::FromStr;

use excavator_model::recording::{CylinderSignals, Recording};
use serde::{Deserialize, Serialize};

use super::error::MapError;
use super::unit::Dimension;

/// A kind of signal, independent of the cylinder.
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

    /// The name in the messages.
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

    /// Whether a number of this dimension is a valid value without conversion. A motor has an angle instead of a
    /// displacement, and a valve opening may be a voltage, a current, a flow, a pilot pressure or a ratio if the model defines it so.
    pub fn takes(self, dimension: Dimension) -> bool {
        dimension == self.dimension()
            || match self {
                SignalKind::Displacement => dimension == Dimension::Angle,
                SignalKind::Velocity => dimension == Dimension::RotationalSpeed,
                SignalKind::OrificeArea | SignalKind::OrificeCommand => {
                    matches!(
                        dimension,
                        Dimension::Voltage
                            | Dimension::Current
                            | Dimension::Number
                            | Dimension::Flow
                            | Dimension::Pressure
                    )
                }
                _ => false,
            }
    }

    /// Interval up to which it cannot jump away and back between two samples, s; `None` for one that can. A piston that goes
    /// 30 mm and back in 20 ms needs 30 times the acceleration of gravity; oil in hoses resonates below 100 Hz.
    pub fn calm_interval(self) -> Option<f64> {
        match self {
            SignalKind::JointAngle | SignalKind::Displacement => Some(0.02),
            SignalKind::Velocity | SignalKind::CapPressure | SignalKind::RodPressure | SignalKind::RodForce => {
                Some(0.005)
            }
            SignalKind::PumpPressure | SignalKind::TankPressure => Some(0.005),
            SignalKind::OrificeArea | SignalKind::OrificeCommand => None,
            SignalKind::PumpFlow | SignalKind::OilTemperature => None,
        }
    }

    /// Its dimension.
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
    /// The column of this signal in the recording; adds the cylinder if it does not exist yet.
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
