//! The plant: one arm cylinder with its valve section and pump, boom held, with effects that may be hidden in it.
//!
//! Every hidden effect is a set of numbers that are zero in a plant without it. One file per part of the machine.

mod base;
mod catalogue_kinds;
mod equations;
mod extras;
mod foreign;
mod foreign_kinds;
mod friction;
mod geometry;
mod integrator;
mod kinds;
mod load;
mod oil;
mod pump;
mod sensors;
mod valve;

pub use base::Base;
pub use catalogue_kinds::CATALOGUE;
pub use equations::{Flows, Forces, Plant, STATES, State};
pub use extras::Extras;
pub use foreign::Foreign;
pub use foreign_kinds::FOREIGN;
pub use friction::{Friction, Reversal, ReversalLaw};
pub use geometry::{Geometry, MAXIMUM_OPENING, PUMP_FLOW, STROKE, TANK_PRESSURE};
pub use integrator::{STEP, step};
pub use kinds::{Kind, Shape};
pub use load::Load;
pub use oil::Oil;
pub use pump::Pump;
pub use sensors::Sensors;
pub use valve::{Lag, Valve};

/// All effects that can be hidden. `Effects::default()` hides nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effects {
    /// In the valve section.
    pub valve: Valve,
    /// Between piston and barrel.
    pub friction: Friction,
    /// In the chambers' oil.
    pub oil: Oil,
    /// At the pump line.
    pub pump: Pump,
    /// On the arm.
    pub load: Load,
    /// In the instruments.
    pub sensors: Sensors,
    /// In nobody's catalogue.
    pub foreign: Foreign,
}

/// The kind of this name.
pub fn kind(name: &str) -> Option<&'static Kind> {
    CATALOGUE.iter().chain(FOREIGN).find(|kind| kind.name == name)
}
