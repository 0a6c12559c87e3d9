//! The machine part of a model file.

use serde::{Deserialize, Serialize};

use super::DocumentError;
use super::quantity::{Must, Quantity};
use crate::machine::{
    Chambers, Cylinder, ImposedMotion, Linkage, Machine, Mechanism, PressureSource, PumpLine, Supply,
};
use crate::model::PLACES_BESIDE_CYLINDERS;

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MachineText {
    name: String,
    description: String,
    gravity: Quantity,
    mechanism: MechanismText,
    supply: SupplyText,
    cylinders: Vec<CylinderText>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum MechanismText {
    SingleLink { base_angle: Quantity },
    TwoLink,
    PlanarChain { link_lengths: Vec<Quantity> },
    LinearLoad,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum SupplyText {
    PumpLine { volume: Quantity, flow: Quantity, tank_pressure: Quantity },
    PressureSource { pressure: Quantity, tank_pressure: Quantity },
    None,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CylinderText {
    name: String,
    stroke: Quantity,
    linkage: LinkageText,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    chambers: Option<ChambersText>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    imposed_motion: Option<ImposedMotionText>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
enum LinkageText {
    Triangle { foot_arm: Quantity, rod_arm: Quantity, mid_stroke_length: Quantity, mirrored: bool },
    Direct,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ChambersText {
    cap_area: Quantity,
    rod_area: Quantity,
    cap_dead_volume: Quantity,
    rod_dead_volume: Quantity,
    maximum_orifice_area: Quantity,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ImposedMotionText {
    cap_area: Quantity,
    rod_area: Quantity,
}

impl MachineText {
    /// The machine, every unit and range checked.
    pub fn machine(&self, name: &str) -> Result<Machine, DocumentError> {
        use Must::{BeAboveVacuum, BeFinite, BePositive, NotBeNegative};
        let mechanism = match &self.mechanism {
            MechanismText::SingleLink { base_angle } => {
                Mechanism::SingleLink { base_angle: base_angle.checked(name, "base_angle", "rad", BeFinite)? }
            }
            MechanismText::TwoLink => Mechanism::TwoLink,
            MechanismText::PlanarChain { link_lengths } => Mechanism::PlanarChain {
                link_lengths: link_lengths
                    .iter()
                    .map(|length| length.checked(name, "link_lengths", "m", BePositive))
                    .collect::<Result<_, _>>()?,
            },
            MechanismText::LinearLoad => Mechanism::LinearLoad,
        };
        let supply = match &self.supply {
            SupplyText::PumpLine { volume, flow, tank_pressure } => Supply::PumpLine(PumpLine {
                volume: volume.checked(name, "supply.volume", "m3", BePositive)?,
                flow: flow.checked(name, "supply.flow", "m3/s", BePositive)?,
                tank_pressure: tank_pressure.checked(name, "supply.tank_pressure", "Pa", BeAboveVacuum)?,
            }),
            SupplyText::PressureSource { pressure, tank_pressure } => Supply::PressureSource(PressureSource {
                pressure: pressure.checked(name, "supply.pressure", "Pa", BePositive)?,
                tank_pressure: tank_pressure.checked(name, "supply.tank_pressure", "Pa", BeAboveVacuum)?,
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
            gravity: self.gravity.checked(name, "gravity", "m/s2", NotBeNegative)?,
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
            gravity: Quantity::new(machine.gravity, "m/s2"),
            mechanism: match &machine.mechanism {
                Mechanism::SingleLink { base_angle } => {
                    MechanismText::SingleLink { base_angle: Quantity::new(*base_angle, "rad") }
                }
                Mechanism::TwoLink => MechanismText::TwoLink,
                Mechanism::PlanarChain { link_lengths } => MechanismText::PlanarChain {
                    link_lengths: link_lengths.iter().map(|&length| Quantity::new(length, "m")).collect(),
                },
                Mechanism::LinearLoad => MechanismText::LinearLoad,
            },
            supply: match machine.supply {
                Supply::PumpLine(line) => SupplyText::PumpLine {
                    volume: Quantity::new(line.volume, "m3"),
                    flow: Quantity::new(line.flow, "m3/s"),
                    tank_pressure: Quantity::new(line.tank_pressure, "Pa"),
                },
                Supply::PressureSource(source) => SupplyText::PressureSource {
                    pressure: Quantity::new(source.pressure, "Pa"),
                    tank_pressure: Quantity::new(source.tank_pressure, "Pa"),
                },
                Supply::None => SupplyText::None,
            },
            cylinders: machine.cylinders.iter().map(CylinderText::of).collect(),
        }
    }
}

impl CylinderText {
    fn cylinder(&self, name: &str) -> Result<Cylinder, DocumentError> {
        let positive = |quantity: &Quantity, what: &str, unit: &'static str| {
            quantity.checked(name, &format!("{}.{what}", self.name), unit, Must::BePositive)
        };
        let linkage = match &self.linkage {
            LinkageText::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => Linkage::Triangle {
                foot_arm: positive(foot_arm, "linkage.foot_arm", "m")?,
                rod_arm: positive(rod_arm, "linkage.rod_arm", "m")?,
                mid_stroke_length: positive(mid_stroke_length, "linkage.mid_stroke_length", "m")?,
                mirrored: *mirrored,
            },
            LinkageText::Direct => Linkage::Direct,
        };
        let chambers = match &self.chambers {
            None => None,
            Some(text) => Some(Chambers {
                cap_area: positive(&text.cap_area, "chambers.cap_area", "m2")?,
                rod_area: positive(&text.rod_area, "chambers.rod_area", "m2")?,
                cap_dead_volume: positive(&text.cap_dead_volume, "chambers.cap_dead_volume", "m3")?,
                rod_dead_volume: positive(&text.rod_dead_volume, "chambers.rod_dead_volume", "m3")?,
                maximum_orifice_area: positive(&text.maximum_orifice_area, "chambers.maximum_orifice_area", "m2")?,
            }),
        };
        let imposed_motion = match &self.imposed_motion {
            None => None,
            Some(text) => Some(ImposedMotion {
                cap_area: positive(&text.cap_area, "imposed_motion.cap_area", "m2")?,
                rod_area: positive(&text.rod_area, "imposed_motion.rod_area", "m2")?,
            }),
        };
        let stroke = positive(&self.stroke, "stroke", "m")?;
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
            stroke: Quantity::new(cylinder.stroke, "m"),
            linkage: match cylinder.linkage {
                Linkage::Triangle { foot_arm, rod_arm, mid_stroke_length, mirrored } => LinkageText::Triangle {
                    foot_arm: Quantity::new(foot_arm, "m"),
                    rod_arm: Quantity::new(rod_arm, "m"),
                    mid_stroke_length: Quantity::new(mid_stroke_length, "m"),
                    mirrored,
                },
                Linkage::Direct => LinkageText::Direct,
            },
            chambers: cylinder.chambers.map(|chambers| ChambersText {
                cap_area: Quantity::new(chambers.cap_area, "m2"),
                rod_area: Quantity::new(chambers.rod_area, "m2"),
                cap_dead_volume: Quantity::new(chambers.cap_dead_volume, "m3"),
                rod_dead_volume: Quantity::new(chambers.rod_dead_volume, "m3"),
                maximum_orifice_area: Quantity::new(chambers.maximum_orifice_area, "m2"),
            }),
            imposed_motion: cylinder.imposed_motion.map(|imposed| ImposedMotionText {
                cap_area: Quantity::new(imposed.cap_area, "m2"),
                rod_area: Quantity::new(imposed.rod_area, "m2"),
            }),
        }
    }
}
