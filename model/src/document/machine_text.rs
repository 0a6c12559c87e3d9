//! The machine part of a model file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::DocumentError;
use super::cylinder_text::CylinderText;
use super::quantity::{Acceleration, Angle, Flow, Length, Position, Pressure, Quantity, TankPressure, Volume};
use crate::machine::{Cylinder, Drive, Linkage, Machine, Mechanism, PressureSource, PumpLine, Supply, Swing};
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
    /// One cylinder or motor for each joint, in the order of the joints.
    cylinders: Vec<CylinderText>,
}

/// How joints move.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum MechanismText {
    /// One link that turns about a joint whose base is held.
    SingleLink {
        /// Angle at which everything before the joint is held. The link hangs down where it and the joint's angle cancel.
        base_angle: Quantity<Angle>,
    },
    /// Two links, the second on the end of the first, in one vertical plane.
    TwoLink,
    /// A chain of links in one vertical plane, each on the end of the one before.
    PlanarChain {
        /// Distance from each joint to the next: one less than there are links.
        link_lengths: Vec<Quantity<Length>>,
        /// For a house that turns with all links about an upright axis: its cylinder or motor comes first.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        swing: Option<SwingText>,
    },
    /// A mass on the rod.
    LinearLoad,
    /// An inertia that turns about a fixed axis: a drum, a wheel, a turntable.
    Rotor,
}

/// For a house that turns with all links about an upright axis: its cylinder or motor comes first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct SwingText {
    /// Distance from the axis to the first link's joint.
    boom_foot: Quantity<Position>,
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

impl MachineText {
    /// The machine, every unit and range checked.
    pub fn machine(&self, name: &str) -> Result<Machine, DocumentError> {
        let mechanism = match &self.mechanism {
            MechanismText::SingleLink { base_angle } => {
                Mechanism::SingleLink { base_angle: base_angle.checked(name, "base_angle")? }
            }
            MechanismText::TwoLink => Mechanism::TwoLink,
            MechanismText::PlanarChain { link_lengths, swing } => Mechanism::PlanarChain {
                link_lengths: link_lengths
                    .iter()
                    .map(|length| length.checked(name, "link_lengths"))
                    .collect::<Result<_, _>>()?,
                swing: match swing {
                    None => None,
                    Some(text) => Some(Swing { boom_foot: text.boom_foot.checked(name, "swing.boom_foot")? }),
                },
            },
            MechanismText::LinearLoad => Mechanism::LinearLoad,
            MechanismText::Rotor => Mechanism::Rotor,
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
        if let Some(reason) = why_not_one_machine(&mechanism, &supply, &cylinders) {
            return Err(DocumentError::Inconsistent { name: name.to_string(), reason });
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
                Mechanism::PlanarChain { link_lengths, swing } => MechanismText::PlanarChain {
                    link_lengths: link_lengths.iter().map(|&length| Quantity::new(length)).collect(),
                    swing: swing.map(|swing| SwingText { boom_foot: Quantity::new(swing.boom_foot) }),
                },
                Mechanism::LinearLoad => MechanismText::LinearLoad,
                Mechanism::Rotor => MechanismText::Rotor,
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
            cylinders: machine
                .cylinders
                .iter()
                .map(|cylinder| CylinderText::of(cylinder, &machine.mechanism))
                .collect(),
        }
    }
}

/// Why parts that are right by themselves do not make a machine.
fn why_not_one_machine(mechanism: &Mechanism, supply: &Supply, cylinders: &[Cylinder]) -> Option<String> {
    if cylinders.len() != mechanism.joints() {
        return Some(format!(
            "the mechanism has {} joint(s), but there are {} cylinder(s); each joint needs one",
            mechanism.joints(),
            cylinders.len()
        ));
    }
    let with_chambers = cylinders.iter().filter(|c| c.chambers.is_some()).count();
    if with_chambers != 0 && with_chambers != cylinders.len() {
        return Some("either all cylinders have chambers or none".into());
    }
    if (with_chambers != 0) == (*supply == Supply::None) {
        return Some("cylinders with chambers need a supply, cylinders without must have none".into());
    }
    let imposed = cylinders.iter().filter(|c| c.imposed_motion.is_some()).count();
    if imposed != 0 && (with_chambers != 0 || imposed != cylinders.len()) {
        return Some(
            "imposed_motion is for all cylinders or none, and in the place of chambers: pressures are measured then"
                .into(),
        );
    }
    for (index, cylinder) in cylinders.iter().enumerate() {
        let is_reserved = PLACES_BESIDE_CYLINDERS.contains(&cylinder.name.as_str());
        if is_reserved || cylinders[..index].iter().any(|other| other.name == cylinder.name) {
            return Some(format!("cylinder name \"{}\" is taken; names are unique", cylinder.name));
        }
        let own_pump = cylinder.chambers.is_some_and(|chambers| matches!(chambers.drive, Drive::Pump { .. }));
        if own_pump && !matches!(supply, Supply::PressureSource(_)) {
            return Some(format!(
                "{}: a pump of its own needs a charge line, which is a supply of kind pressure_source",
                cylinder.name
            ));
        }
        let linear = matches!(mechanism, Mechanism::LinearLoad);
        match cylinder.linkage {
            Linkage::Direct if !linear => {
                return Some(format!("{}: a direct linkage needs the mechanism linear_load", cylinder.name));
            }
            Linkage::Triangle { .. } if linear || *mechanism == Mechanism::Rotor => {
                return Some(format!("{}: a triangle turns a link; this mechanism has none", cylinder.name));
            }
            _ => {}
        }
    }
    None
}
