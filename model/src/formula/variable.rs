//! The variables that a formula may use.

use super::dimension::Dimension;

/// A quantity of the machine at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Variable {
    Displacement,
    Velocity,
    Joint,
    Rate,
    Lever,
    CapPressure,
    RodPressure,
    PumpPressure,
    TankPressure,
    Opening,
    LargestOpening,
    Command,
    CapFlow,
    RodFlow,
    RodForce,
    CapArea,
    RodArea,
    Stroke,
    Time,
    Temperature,
}

/// Name and description of a variable.
pub(super) struct VariableCard {
    pub name: &'static str,
    pub variable: Variable,
    /// SI unit.
    pub unit: &'static str,
    /// Its meaning.
    pub meaning: &'static str,
}

const fn card(name: &'static str, variable: Variable, unit: &'static str, meaning: &'static str) -> VariableCard {
    VariableCard { name, variable, unit, meaning }
}

/// All variables.
pub(super) static VARIABLES: [VariableCard; 20] = [
    card("s", Variable::Displacement, "m", "piston displacement from mid-stroke"),
    card("v", Variable::Velocity, "m/s", "piston velocity"),
    card("q", Variable::Joint, "rad", "joint coordinate"),
    card("qd", Variable::Rate, "rad/s", "joint rate"),
    card("lever", Variable::Lever, "m", "lever of the cylinder on its joint"),
    card("p_cap", Variable::CapPressure, "Pa", "cap side pressure"),
    card("p_rod", Variable::RodPressure, "Pa", "rod side pressure"),
    card("p_pump", Variable::PumpPressure, "Pa", "pump pressure"),
    card("p_tank", Variable::TankPressure, "Pa", "tank pressure"),
    card("u", Variable::Opening, "m2", "opening of the metering edges"),
    card("u_max", Variable::LargestOpening, "m2", "largest opening of the valve section"),
    card("command", Variable::Command, "m2", "opening that the recording gives"),
    card("flow_cap", Variable::CapFlow, "m3/s", "metering flow into the cap side"),
    card("flow_rod", Variable::RodFlow, "m3/s", "metering flow into the rod side"),
    card("rod_force", Variable::RodForce, "N", "force measured on the rod"),
    card("area_cap", Variable::CapArea, "m2", "piston area on the cap side"),
    card("area_rod", Variable::RodArea, "m2", "piston area on the rod side"),
    card("stroke", Variable::Stroke, "m", "stroke of the cylinder"),
    card("t", Variable::Time, "s", "time since the first sample"),
    card("temperature", Variable::Temperature, "degC", "oil temperature"),
];

impl Variable {
    /// The card of the variable.
    pub fn card(self) -> &'static VariableCard {
        let found = VARIABLES.iter().find(|card| card.variable == self);
        // Every variable has a card; the fallback is unreachable.
        found.unwrap_or(&VARIABLES[0])
    }

    /// Its unit.
    pub fn dimension(self) -> Dimension {
        Dimension::read(self.card().unit).unwrap_or(Dimension::PURE)
    }

    /// Whether it belongs to one cylinder.
    pub fn is_of_a_cylinder(self) -> bool {
        !matches!(self, Variable::PumpPressure | Variable::TankPressure | Variable::Time | Variable::Temperature)
    }

    /// Whether only a cylinder with oil in its chambers has it.
    pub fn needs_oil(self) -> bool {
        matches!(
            self,
            Variable::Opening | Variable::LargestOpening | Variable::Command | Variable::CapFlow | Variable::RodFlow
        )
    }

    /// Whether only a cylinder with known pressures has it.
    pub fn needs_pressures(self) -> bool {
        self.needs_oil()
            || matches!(self, Variable::CapPressure | Variable::RodPressure | Variable::CapArea | Variable::RodArea)
    }
}

/// Name, SI unit and meaning of every variable.
pub fn variables() -> impl Iterator<Item = [&'static str; 3]> {
    VARIABLES.iter().map(|card| [card.name, card.unit, card.meaning])
}
