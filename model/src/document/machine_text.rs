//! The machine part of a model file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentError;
use super::quantity::{Acceleration, Angle, Area, Flow, Length, Measure, Pressure, Quantity, TankPressure, Volume};
use crate::machine::{
    Chambers, Cylinder, ImposedMotion, Linkage, Machine, Mechanism, PressureSource, PumpLine, Supply,
};
use crate::model::PLACES_BESIDE_CYLINDERS;

/// The machine: geometry and constants, nothing that has to be identified.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct MachineText {
    /// Short name, a word.
    name: String,
    /// What the machine is, for people.
    description: String,
    /// Gravity acceleration.
    gravity: Quantity<Acceleration>,
    /// How joints move.
    mechanism: MechanismText,
    /// Where the oil comes from.
    supply: SupplyText,
    /// One cylinder for each joint, in the order of the joints.
    cylinders: Vec<CylinderText>,
}

/// How joints move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum MechanismText {
    /// One link that turns about a joint whose base is held.
    SingleLink {
        /// Angle at which everything before the joint is held; the link hangs straight down where it and the joint's angle add up to zero.
        base_angle: Quantity<Angle>,
    },
    /// Two links, the second on the end of the first, in one vertical plane.
    TwoLink,
    /// A chain of links in one vertical plane, each on the end of the one before.
    PlanarChain {
        /// Distance from each joint to the next: one less than there are joints.
        link_lengths: Vec<Quantity<Length>>,
    },
    /// A mass on the rod.
    LinearLoad,
}

/// Where the oil comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum SupplyText {
    /// A pump of constant flow that feeds a volume; its pressure moves.
    PumpLine {
        /// Volume of the oil between pump and valves.
        volume: Quantity<Volume>,
        /// Flow of the pump.
        flow: Quantity<Flow>,
        /// Gauge pressure of the tank.
        tank_pressure: Quantity<TankPressure>,
    },
    /// A supply that is kept at one pressure. A recording that measures it overrides it.
    PressureSource {
        /// Gauge pressure of the supply.
        pressure: Quantity<Pressure>,
        /// Gauge pressure of the tank.
        tank_pressure: Quantity<TankPressure>,
    },
    /// No oil: cylinders without chambers, driven by a measured force or moved from outside.
    None,
}

/// A cylinder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct CylinderText {
    /// Its name, a word; "pump" and "machine" are taken.
    name: String,
    /// Full stroke; displacement is counted from its middle.
    stroke: Quantity<Length>,
    /// How the cylinder drives its joint.
    linkage: LinkageText,
    /// Its chambers; left out where a measured force drives it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    chambers: Option<ChambersText>,
    /// For a rod that is moved from outside, where pressures and displacement are measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    imposed_motion: Option<ImposedMotionText>,
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
}

/// The two chambers of a cylinder and the valve at them.
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
    /// Orifice area of a fully open metering edge.
    maximum_orifice_area: Quantity<Area>,
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

impl MachineText {
    /// The machine, every unit and range checked.
    pub fn machine(&self, name: &str) -> Result<Machine, DocumentError> {
        let mechanism = match &self.mechanism {
            MechanismText::SingleLink { base_angle } => {
                Mechanism::SingleLink { base_angle: base_angle.checked(name, "base_angle")? }
            }
            MechanismText::TwoLink => Mechanism::TwoLink,
            MechanismText::PlanarChain { link_lengths } => Mechanism::PlanarChain {
                link_lengths: link_lengths
                    .iter()
                    .map(|length| length.checked(name, "link_lengths"))
                    .collect::<Result<_, _>>()?,
            },
            MechanismText::LinearLoad => Mechanism::LinearLoad,
        };
        let supply = match &self.supply {
            SupplyText::PumpLine { volume, flow, tank_pressure } => Supply::PumpLine(PumpLine {
                volume: volume.checked(name, "supply.volume")?,
                flow: flow.checked(name, "supply.flow")?,
                tank_pressure: tank_pressure.checked(name, "supply.tank_pressure")?,
            }),
            SupplyText::PressureSource { pressure, tank_pressure } => Supply::PressureSource(PressureSource {
                pressure: pressure.checked(name, "supply.pressure")?,
                tank_pressure: tank_pressure.checked(name, "supply.tank_pressure")?,
            }),
            SupplyText::None => Supply::None,
        };
        let cylinders = self.cylinders.iter().map(|c| c.cylinder(name)).collect::<Result<Vec<_>, _>>()?;
        let inconsistent = |reason: String| DocumentError::Inconsistent { name: name.to_string(), reason };
        if cylinders.len() != mechanism.joints() {
            return Err(inconsistent(format!(
                "the mechanism has {} joint(s), but there are {} cylinder(s); each joint needs one",
                mechanism.joints(),
                cylinders.len()
            )));
        }
        let with_chambers = cylinders.iter().filter(|c| c.chambers.is_some()).count();
        if with_chambers != 0 && with_chambers != cylinders.len() {
            return Err(inconsistent("either all cylinders have chambers or none".into()));
        }
        if (with_chambers != 0) == (supply == Supply::None) {
            return Err(inconsistent("cylinders with chambers need a supply, cylinders without must have none".into()));
        }
        let imposed = cylinders.iter().filter(|c| c.imposed_motion.is_some()).count();
        if imposed != 0 && (with_chambers != 0 || imposed != cylinders.len()) {
            return Err(inconsistent(
                "imposed_motion is for all cylinders or none, and in the place of chambers: pressures are measured then".into(),
            ));
        }
        for (index, cylinder) in cylinders.iter().enumerate() {
            let is_reserved = PLACES_BESIDE_CYLINDERS.contains(&cylinder.name.as_str());
            if is_reserved || cylinders[..index].iter().any(|other| other.name == cylinder.name) {
                return Err(inconsistent(format!("cylinder name \"{}\" is taken; names are unique", cylinder.name)));
            }
        }
        Ok(Machine {
            name: self.name.clone(),
            description: self.description.clone(),
            gravity: self.gravity.checked(name, "gravity")?,
            mechanism,
            cylinders,
            supply,
        })
    }

    /// The text of a machine, without sources.
    pub fn of(machine: &Machine) -> Self {
        MachineText {
            name: machine.name.clone(),
            description: machine.description.clone(),
            gravity: Quantity::new(machine.gravity),
            mechanism: match &machine.mechanism {
                Mechanism::SingleLink { base_angle } => {
                    MechanismText::SingleLink { base_angle: Quantity::new(*base_angle) }
                }
                Mechanism::TwoLink => MechanismText::TwoLink,
                Mechanism::PlanarChain { link_lengths } => MechanismText::PlanarChain {
                    link_lengths: link_lengths.iter().map(|&length| Quantity::new(length)).collect(),
                },
                Mechanism::LinearLoad => MechanismText::LinearLoad,
            },
            supply: match machine.supply {
                Supply::PumpLine(line) => SupplyText::PumpLine {
                    volume: Quantity::new(line.volume),
                    flow: Quantity::new(line.flow),
                    tank_pressure: Quantity::new(line.tank_pressure),
                },
                Supply::PressureSource(source) => SupplyText::PressureSource {
                    pressure: Quantity::new(source.pressure),
                    tank_pressure: Quantity::new(source.tank_pressure),
                },
                Supply::None => SupplyText::None,
            },
            cylinders: machine.cylinders.iter().map(CylinderText::of).collect(),
        }
    }
}

impl CylinderText {
    /// A constant of this cylinder.
    fn checked<M: Measure>(&self, name: &str, quantity: &Quantity<M>, what: &str) -> Result<f64, DocumentError> {
        quantity.checked(name, &format!("{}.{what}", self.name))
    }

    fn cylinder(&self, name: &str) -> Result<Cylinder, DocumentError> {
        let linkage = match &self.linkage {
            LinkageText::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => Linkage::Triangle {
                foot_arm: self.checked(name, foot_arm, "linkage.foot_arm")?,
                rod_arm: self.checked(name, rod_arm, "linkage.rod_arm")?,
                mid_stroke_length: self.checked(name, mid_stroke_length, "linkage.mid_stroke_length")?,
                mirrored: *mirrored,
            },
            LinkageText::Direct => Linkage::Direct,
        };
        let chambers = match &self.chambers {
            None => None,
            Some(text) => Some(Chambers {
                cap_area: self.checked(name, &text.cap_area, "chambers.cap_area")?,
                rod_area: self.checked(name, &text.rod_area, "chambers.rod_area")?,
                cap_dead_volume: self.checked(name, &text.cap_dead_volume, "chambers.cap_dead_volume")?,
                rod_dead_volume: self.checked(name, &text.rod_dead_volume, "chambers.rod_dead_volume")?,
                maximum_orifice_area: self.checked(
                    name,
                    &text.maximum_orifice_area,
                    "chambers.maximum_orifice_area",
                )?,
            }),
        };
        let imposed_motion = match &self.imposed_motion {
            None => None,
            Some(text) => Some(ImposedMotion {
                cap_area: self.checked(name, &text.cap_area, "imposed_motion.cap_area")?,
                rod_area: self.checked(name, &text.rod_area, "imposed_motion.rod_area")?,
            }),
        };
        let stroke = self.checked(name, &self.stroke, "stroke")?;
        for end in [-stroke / 2.0, stroke / 2.0] {
            if !linkage.joint(end).is_finite() {
                return Err(DocumentError::Inconsistent {
                    name: name.to_string(),
                    reason: format!("{}: the linkage cannot reach displacement {end} m of its stroke", self.name),
                });
            }
        }
        Ok(Cylinder { name: self.name.clone(), linkage, stroke, chambers, imposed_motion })
    }

    fn of(cylinder: &Cylinder) -> Self {
        CylinderText {
            name: cylinder.name.clone(),
            stroke: Quantity::new(cylinder.stroke),
            linkage: match cylinder.linkage {
                Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => LinkageText::Triangle {
                    foot_arm: Quantity::new(foot_arm),
                    rod_arm: Quantity::new(rod_arm),
                    mid_stroke_length: Quantity::new(mid_stroke_length),
                    mirrored,
                },
                Linkage::Direct => LinkageText::Direct,
            },
            chambers: cylinder.chambers.map(|chambers| ChambersText {
                cap_area: Quantity::new(chambers.cap_area),
                rod_area: Quantity::new(chambers.rod_area),
                cap_dead_volume: Quantity::new(chambers.cap_dead_volume),
                rod_dead_volume: Quantity::new(chambers.rod_dead_volume),
                maximum_orifice_area: Quantity::new(chambers.maximum_orifice_area),
            }),
            imposed_motion: cylinder.imposed_motion.map(|imposed| ImposedMotionText {
                cap_area: Quantity::new(imposed.cap_area),
                rod_area: Quantity::new(imposed.rod_area),
            }),
        }
    }
}
