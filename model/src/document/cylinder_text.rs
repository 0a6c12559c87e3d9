//! A cylinder or motor of a model file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentError;
use super::quantity::{Area, Flow, Length, Measure, MotorVolume, Position, Quantity, Volume};
use crate::machine::{Chambers, CommandUnit, Cylinder, Drive, ImposedMotion, Linkage, Mechanism};

/// A cylinder or motor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct CylinderText {
    /// Its name, a word; "pump" and "machine" are taken.
    name: String,
    /// Full stroke; displacement is counted from its middle. Left out for a motor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stroke: Option<Quantity<Length>>,
    /// Where the piston meets its stops, if that is not at both ends of the stroke.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    end_stops: Option<EndStopsText>,
    /// How the cylinder drives its joint.
    linkage: LinkageText,
    /// Its chambers; left out where a measured force drives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    chambers: Option<ChambersText>,
    /// For a hydraulic motor, in the place of stroke and chambers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    motor: Option<MotorText>,
    /// For a rod that is moved from outside, where pressures and displacement are measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    imposed_motion: Option<ImposedMotionText>,
}

/// Where the piston meets its stops, counted as displacement is.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct EndStopsText {
    /// The stop of the retracted rod; below zero.
    retracted: Quantity<Position>,
    /// The stop of the extended rod.
    extended: Quantity<Position>,
}

/// How a cylinder drives its joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum LinkageText {
    /// A cylinder pinned across a joint: cosine law.
    Triangle {
        /// Distance from the joint to the cylinder's foot pin.
        foot_arm: Quantity<Length>,
        /// Distance from the joint to the rod's pin.
        rod_arm: Quantity<Length>,
        /// Distance from pin to pin at mid-stroke.
        mid_stroke_length: Quantity<Length>,
        /// Whether extension lowers the joint's angle, as on an arm; false on a boom.
        mirrored: bool,
    },
    /// The piston carries the load itself.
    Direct,
    /// A motor turns the joint, or moves a linear load over a drum or pinion.
    Gear {
        /// Angle of the shaft per angle of the joint (unit "-"), or per travel of a linear load (unit "rad/m"); below zero where they turn
        /// opposite ways.
        ratio: RatioText,
    },
}

/// A gear ratio.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct RatioText {
    /// The ratio.
    value: f64,
    /// "-", or "rad/m" for a linear load.
    unit: RatioUnit,
    /// Where the number comes from.
    #[serde(default)]
    source: String,
}

/// Unit of a gear ratio.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
enum RatioUnit {
    #[serde(rename = "-")]
    One,
    #[serde(rename = "rad/m")]
    RadianPerMetre,
}

/// The two chambers of a cylinder and what feeds them: one of maximum_orifice_area, full_command and maximum_pump_flow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ChambersText {
    /// Piston area on the cap side.
    cap_area: Quantity<Area>,
    /// Piston area on the rod side.
    rod_area: Quantity<Area>,
    /// Oil volume of the cap side beyond the stroke: hoses, ports.
    cap_dead_volume: Quantity<Volume>,
    /// Oil volume of the rod side beyond the stroke.
    rod_dead_volume: Quantity<Volume>,
    /// For a valve whose input is an orifice area: that of a fully open metering edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    maximum_orifice_area: Option<Quantity<Area>>,
    /// For a valve whose input is a voltage, a current or a share: the input at which it is fully open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    full_command: Option<CommandText>,
    /// For a pump of the cylinder's own: its flow at full speed and displacement, without losses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    maximum_pump_flow: Option<Quantity<Flow>>,
}

/// A hydraulic motor and what feeds it: one of maximum_orifice_area, full_command and maximum_pump_flow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct MotorText {
    /// Volume per angle of the shaft: that of a turn divided by 2 pi.
    displacement: Quantity<MotorVolume>,
    /// Oil volume between valve and motor on the side that turns it forward, half of the motor's own included.
    cap_volume: Quantity<Volume>,
    /// Oil volume on the other side.
    rod_volume: Quantity<Volume>,
    /// For a valve whose input is an orifice area: that of a fully open metering edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    maximum_orifice_area: Option<Quantity<Area>>,
    /// For a valve whose input is a voltage, a current or a share: the input at which it is fully open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    full_command: Option<CommandText>,
    /// For a pump of the motor's own: its flow at full speed and displacement, without losses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    maximum_pump_flow: Option<Quantity<Flow>>,
}

/// The input at which a valve is fully open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct CommandText {
    /// The input.
    value: f64,
    /// Its unit: "V", "A" or "-".
    unit: ValveInput,
    /// Where the number comes from.
    #[serde(default)]
    source: String,
}

/// Unit of the input of a valve that is not given by its orifice area.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
enum ValveInput {
    #[serde(rename = "V")]
    Volt,
    #[serde(rename = "A")]
    Ampere,
    #[serde(rename = "-")]
    One,
}

/// Piston areas of a rod that is moved from outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ImposedMotionText {
    /// Piston area on the cap side.
    cap_area: Quantity<Area>,
    /// Piston area on the rod side.
    rod_area: Quantity<Area>,
}

impl ValveInput {
    fn unit(self) -> CommandUnit {
        match self {
            ValveInput::Volt => CommandUnit::Volt,
            ValveInput::Ampere => CommandUnit::Ampere,
            ValveInput::One => CommandUnit::One,
        }
    }
}

impl CylinderText {
    /// A constant of this cylinder.
    fn checked<M: Measure>(&self, name: &str, quantity: &Quantity<M>, what: &str) -> Result<f64, DocumentError> {
        quantity.checked(name, &format!("{}.{what}", self.name))
    }

    fn inconsistent(&self, name: &str, reason: impl std::fmt::Display) -> DocumentError {
        DocumentError::Inconsistent { name: name.to_string(), reason: format!("{}: {reason}", self.name) }
    }

    /// A number whose unit serde has checked.
    fn positive(&self, name: &str, what: &str, value: f64) -> Result<f64, DocumentError> {
        if value.is_finite() && value > 0.0 {
            return Ok(value);
        }
        Err(DocumentError::Impossible {
            name: name.to_string(),
            quantity: format!("{}.{what}", self.name),
            value,
            must: "a positive number".to_string(),
        })
    }

    /// The cylinder, every unit and range checked.
    pub fn cylinder(&self, name: &str) -> Result<Cylinder, DocumentError> {
        let linkage = self.linkage(name)?;
        let (stroke, chambers) = match (&self.stroke, &self.chambers, &self.motor) {
            (None, None, Some(motor)) => (f64::INFINITY, Some(self.motor(name, motor)?)),
            (Some(stroke), chambers, None) => {
                let chambers = chambers.as_ref().map(|text| self.chambers(name, text)).transpose()?;
                (self.checked(name, stroke, "stroke")?, chambers)
            }
            (None, _, None) => return Err(self.inconsistent(name, "it has neither a stroke nor a motor")),
            (_, _, Some(_)) => {
                return Err(
                    self.inconsistent(name, "a motor stands in the place of stroke and chambers; leave these out")
                );
            }
        };
        if self.motor.is_some() != matches!(linkage, Linkage::Gear { .. }) {
            return Err(self.inconsistent(name, "a motor needs a linkage of kind gear, and a cylinder another one"));
        }
        let imposed_motion = match &self.imposed_motion {
            None => None,
            Some(text) => Some(ImposedMotion {
                cap_area: self.checked(name, &text.cap_area, "imposed_motion.cap_area")?,
                rod_area: self.checked(name, &text.rod_area, "imposed_motion.rod_area")?,
            }),
        };
        let ends = self.ends(name, stroke)?;
        for end in [-stroke / 2.0, stroke / 2.0].into_iter().chain(ends).filter(|end| end.is_finite()) {
            if !linkage.joint(end).is_finite() {
                return Err(
                    self.inconsistent(name, format!("the linkage cannot reach displacement {end} m of its stroke"))
                );
            }
        }
        Ok(Cylinder { name: self.name.clone(), linkage, stroke, ends, chambers, imposed_motion })
    }

    fn ends(&self, name: &str, stroke: f64) -> Result<[f64; 2], DocumentError> {
        let Some(stops) = &self.end_stops else { return Ok([-stroke / 2.0, stroke / 2.0]) };
        let retracted = self.checked(name, &stops.retracted, "end_stops.retracted")?;
        let extended = self.checked(name, &stops.extended, "end_stops.extended")?;
        let apart = extended - retracted;
        // What is farther apart than the stroke by a tenth is a stroke in other words.
        if self.motor.is_some() || apart <= 0.0 || apart > 1.1 * stroke {
            return Err(self.inconsistent(
                name,
                format!("end_stops at {retracted} m and {extended} m do not fit a stroke of {stroke} m, counted from its middle"),
            ));
        }
        Ok([retracted, extended])
    }

    fn linkage(&self, name: &str) -> Result<Linkage, DocumentError> {
        Ok(match &self.linkage {
            LinkageText::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => Linkage::Triangle {
                foot_arm: self.checked(name, foot_arm, "linkage.foot_arm")?,
                rod_arm: self.checked(name, rod_arm, "linkage.rod_arm")?,
                mid_stroke_length: self.checked(name, mid_stroke_length, "linkage.mid_stroke_length")?,
                mirrored: *mirrored,
            },
            LinkageText::Direct => Linkage::Direct,
            LinkageText::Gear { ratio } => {
                self.positive(name, "linkage.ratio", ratio.value.abs())?;
                Linkage::Gear { ratio: ratio.value }
            }
        })
    }

    fn chambers(&self, name: &str, text: &ChambersText) -> Result<Chambers, DocumentError> {
        Ok(Chambers {
            cap_area: self.checked(name, &text.cap_area, "chambers.cap_area")?,
            rod_area: self.checked(name, &text.rod_area, "chambers.rod_area")?,
            cap_dead_volume: self.checked(name, &text.cap_dead_volume, "chambers.cap_dead_volume")?,
            rod_dead_volume: self.checked(name, &text.rod_dead_volume, "chambers.rod_dead_volume")?,
            drive: self.drive(
                name,
                "chambers",
                (&text.maximum_orifice_area, &text.full_command, &text.maximum_pump_flow),
            )?,
        })
    }

    fn motor(&self, name: &str, text: &MotorText) -> Result<Chambers, DocumentError> {
        let displacement = self.checked(name, &text.displacement, "motor.displacement")?;
        Ok(Chambers {
            cap_area: displacement,
            rod_area: displacement,
            cap_dead_volume: self.checked(name, &text.cap_volume, "motor.cap_volume")?,
            rod_dead_volume: self.checked(name, &text.rod_volume, "motor.rod_volume")?,
            drive: self.drive(
                name,
                "motor",
                (&text.maximum_orifice_area, &text.full_command, &text.maximum_pump_flow),
            )?,
        })
    }

    fn drive(&self, name: &str, table: &str, given: Given<'_>) -> Result<Drive, DocumentError> {
        match given {
            (Some(area), None, None) => {
                let full_command = self.checked(name, area, &format!("{table}.maximum_orifice_area"))?;
                Ok(Drive::Valve { full_command, unit: CommandUnit::SquareMetre })
            }
            (None, Some(command), None) => {
                let full_command = self.positive(name, &format!("{table}.full_command"), command.value)?;
                Ok(Drive::Valve { full_command, unit: command.unit.unit() })
            }
            (None, None, Some(flow)) => {
                Ok(Drive::Pump { full_flow: self.checked(name, flow, &format!("{table}.maximum_pump_flow"))? })
            }
            _ => Err(self.inconsistent(
                name,
                format!(
                    "{table} needs one of maximum_orifice_area and full_command, for a valve, or maximum_pump_flow, for a pump of its own"
                ),
            )),
        }
    }

    /// The text of a cylinder, without sources.
    pub fn of(cylinder: &Cylinder, mechanism: &Mechanism) -> Self {
        let half = cylinder.stroke / 2.0;
        let moved = cylinder.ends != [-half, half];
        let is_motor = cylinder.is_motor();
        CylinderText {
            name: cylinder.name.clone(),
            stroke: (!is_motor).then(|| Quantity::new(cylinder.stroke)),
            end_stops: (moved && !is_motor).then(|| EndStopsText {
                retracted: Quantity::new(cylinder.ends[0]),
                extended: Quantity::new(cylinder.ends[1]),
            }),
            linkage: match cylinder.linkage {
                Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => LinkageText::Triangle {
                    foot_arm: Quantity::new(foot_arm),
                    rod_arm: Quantity::new(rod_arm),
                    mid_stroke_length: Quantity::new(mid_stroke_length),
                    mirrored,
                },
                Linkage::Direct => LinkageText::Direct,
                Linkage::Gear { ratio } => {
                    let is_linear = *mechanism == Mechanism::LinearLoad;
                    let unit = if is_linear { RatioUnit::RadianPerMetre } else { RatioUnit::One };
                    LinkageText::Gear { ratio: RatioText { value: ratio, unit, source: String::new() } }
                }
            },
            chambers: cylinder.chambers.filter(|_| !is_motor).map(|chambers| {
                let (maximum_orifice_area, full_command, maximum_pump_flow) = drive_text(chambers.drive);
                ChambersText {
                    cap_area: Quantity::new(chambers.cap_area),
                    rod_area: Quantity::new(chambers.rod_area),
                    cap_dead_volume: Quantity::new(chambers.cap_dead_volume),
                    rod_dead_volume: Quantity::new(chambers.rod_dead_volume),
                    maximum_orifice_area,
                    full_command,
                    maximum_pump_flow,
                }
            }),
            motor: cylinder.chambers.filter(|_| is_motor).map(|chambers| {
                let (maximum_orifice_area, full_command, maximum_pump_flow) = drive_text(chambers.drive);
                MotorText {
                    displacement: Quantity::new(chambers.cap_area),
                    cap_volume: Quantity::new(chambers.cap_dead_volume),
                    rod_volume: Quantity::new(chambers.rod_dead_volume),
                    maximum_orifice_area,
                    full_command,
                    maximum_pump_flow,
                }
            }),
            imposed_motion: cylinder.imposed_motion.map(|imposed| ImposedMotionText {
                cap_area: Quantity::new(imposed.cap_area),
                rod_area: Quantity::new(imposed.rod_area),
            }),
        }
    }
}

/// The three ways to say what feeds the chambers.
type Given<'a> = (&'a Option<Quantity<Area>>, &'a Option<CommandText>, &'a Option<Quantity<Flow>>);

fn drive_text(drive: Drive) -> (Option<Quantity<Area>>, Option<CommandText>, Option<Quantity<Flow>>) {
    let command = |value, unit| Some(CommandText { value, unit, source: String::new() });
    match drive {
        Drive::Valve { full_command, unit: CommandUnit::Volt } => (None, command(full_command, ValveInput::Volt), None),
        Drive::Valve { full_command, unit: CommandUnit::Ampere } => {
            (None, command(full_command, ValveInput::Ampere), None)
        }
        Drive::Valve { full_command, unit: CommandUnit::One } => (None, command(full_command, ValveInput::One), None),
        Drive::Valve { full_command, .. } => (Some(Quantity::new(full_command)), None, None),
        Drive::Pump { full_flow } => (None, None, Some(Quantity::new(full_flow))),
    }
}
