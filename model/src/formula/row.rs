//! Rows of the equations that a formula can enter.

use super::dimension::Dimension;
use crate::effects::{ActsOn, Needs};

/// The quantity that a formula computes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Row {
    /// Force on the piston along its extension, N.
    PistonForce,
    /// Torque on the cylinder's joint, N m (on a linear load its force, N).
    JointTorque,
    /// Flow into the cap side from outside, m³/s.
    CapFlow,
    /// Flow into the rod side from outside, m³/s.
    RodFlow,
    /// Flow from the cap to the rod side, m³/s.
    PistonLeak,
    /// Flow from the pump line to the tank, m³/s.
    PumpLeak,
    /// Flow from the pump line to the cap side, m³/s.
    PumpToCap,
    /// Flow from the pump line to the rod side, m³/s.
    PumpToRod,
    /// Flow from the cap side to the tank, m³/s.
    CapToTank,
    /// Flow from the rod side to the tank, m³/s.
    RodToTank,
    /// Opening of the metering edges, m².
    Opening,
    /// Opening of the edge through which oil comes from the pump line, m².
    SupplyOpening,
    /// Opening of the edge through which oil returns to the tank, m².
    ReturnOpening,
    /// Offset of the cap pressure reading, Pa.
    CapPressureReading,
    /// Offset of the rod pressure reading, Pa.
    RodPressureReading,
    /// Offset of the pump pressure reading, Pa.
    PumpPressureReading,
    /// Offset of the displacement reading, m.
    DisplacementReading,
}

/// Description of a row.
pub struct RowCard {
    /// Its name in catalogue files.
    pub name: &'static str,
    /// The row.
    pub row: Row,
    /// Unit of its formula.
    pub unit: &'static str,
    /// The quantity that the formula computes.
    pub meaning: &'static str,
    /// Signature of an effect in this row in data.
    pub shows: &'static str,
    /// Its part in the energy balance.
    pub energy: &'static str,
}

const fn card(
    name: &'static str,
    row: Row,
    unit: &'static str,
    meaning: &'static str,
    shows: &'static str,
    energy: &'static str,
) -> RowCard {
    RowCard { name, row, unit, meaning, shows, energy }
}

const FORCE: &str = "In the force balance of the cylinder.";
const CHAMBERS: &str = "In the oil balances of the chambers.";
const INSTRUMENT: &str = "In one reading, and in nothing that the machine does.";
const FLOW_POWER: &str = "Flow times the pressures at both of its ends.";
const THROUGH_THE_VALVE: &str = "Changes the flows through the valve; dissipates nothing itself.";
const NO_POWER: &str = "None: it acts on the instrument.";

/// All rows.
pub static ROWS: [RowCard; 17] = [
    card(
        "piston_force",
        Row::PistonForce,
        "N",
        "force on the piston along its extension",
        FORCE,
        "Force times piston velocity.",
    ),
    card("joint_torque", Row::JointTorque, "N m", "torque on the cylinder's joint", FORCE, "Torque times joint rate."),
    card("cap_flow", Row::CapFlow, "m3/s", "flow into the cap side from outside", CHAMBERS, FLOW_POWER),
    card("rod_flow", Row::RodFlow, "m3/s", "flow into the rod side from outside", CHAMBERS, FLOW_POWER),
    card("piston_leak", Row::PistonLeak, "m3/s", "flow from the cap to the rod side", CHAMBERS, FLOW_POWER),
    card(
        "pump_leak",
        Row::PumpLeak,
        "m3/s",
        "flow from the pump line to the tank",
        "In the oil balance of the pump line.",
        FLOW_POWER,
    ),
    card("pump_to_cap", Row::PumpToCap, "m3/s", "flow from the pump line to the cap side", CHAMBERS, FLOW_POWER),
    card("pump_to_rod", Row::PumpToRod, "m3/s", "flow from the pump line to the rod side", CHAMBERS, FLOW_POWER),
    card("cap_to_tank", Row::CapToTank, "m3/s", "flow from the cap side to the tank", CHAMBERS, FLOW_POWER),
    card("rod_to_tank", Row::RodToTank, "m3/s", "flow from the rod side to the tank", CHAMBERS, FLOW_POWER),
    card(
        "opening",
        Row::Opening,
        "m2",
        "opening of the metering edges",
        "In the flows through the valve.",
        THROUGH_THE_VALVE,
    ),
    card(
        "supply_opening",
        Row::SupplyOpening,
        "m2",
        "opening of the edge through which oil comes from the pump line",
        "In the flow from the pump line, and not in the flow to the tank.",
        THROUGH_THE_VALVE,
    ),
    card(
        "return_opening",
        Row::ReturnOpening,
        "m2",
        "opening of the edge through which oil returns to the tank",
        "In the flow to the tank, and not in the flow from the pump line: a filter or a check valve in the return line.",
        THROUGH_THE_VALVE,
    ),
    card(
        "cap_pressure_reading",
        Row::CapPressureReading,
        "Pa",
        "what the cap pressure's instrument adds",
        INSTRUMENT,
        NO_POWER,
    ),
    card(
        "rod_pressure_reading",
        Row::RodPressureReading,
        "Pa",
        "what the rod pressure's instrument adds",
        INSTRUMENT,
        NO_POWER,
    ),
    card(
        "pump_pressure_reading",
        Row::PumpPressureReading,
        "Pa",
        "what the pump pressure's instrument adds",
        INSTRUMENT,
        NO_POWER,
    ),
    card(
        "displacement_reading",
        Row::DisplacementReading,
        "m",
        "what the displacement's instrument adds",
        INSTRUMENT,
        NO_POWER,
    ),
];

impl Row {
    /// The card of the row.
    pub fn card(self) -> &'static RowCard {
        // Every row has a card; the fallback is unreachable.
        ROWS.iter().find(|card| card.row == self).unwrap_or(&ROWS[0])
    }

    /// Unit of its formula.
    pub fn dimension(self) -> Dimension {
        Dimension::read(self.card().unit).unwrap_or(Dimension::PURE)
    }

    /// The part of the machine that effects in this row act on.
    pub fn acts_on(self) -> ActsOn {
        match self {
            Row::PumpLeak | Row::PumpPressureReading => ActsOn::PumpLine,
            Row::PumpToCap | Row::PumpToRod | Row::CapToTank | Row::RodToTank => ActsOn::Valve,
            row if row.is_an_opening() => ActsOn::Valve,
            _ => ActsOn::Cylinder,
        }
    }

    /// What a cylinder must have.
    pub fn needs(self) -> Needs {
        match self {
            Row::PistonForce | Row::JointTorque | Row::DisplacementReading => Needs::Nothing,
            Row::CapPressureReading | Row::RodPressureReading => Needs::Pressures,
            _ => Needs::Oil,
        }
    }

    /// Whether the row is an opening of the valve's edges.
    pub fn is_an_opening(self) -> bool {
        matches!(self, Row::Opening | Row::SupplyOpening | Row::ReturnOpening)
    }

    /// Whether the row is an instrument reading.
    pub fn is_a_reading(self) -> bool {
        matches!(
            self,
            Row::CapPressureReading | Row::RodPressureReading | Row::PumpPressureReading | Row::DisplacementReading
        )
    }
}
