//! Places of the ledger: one for each equation of the model.

use excavator_model::Model;
use excavator_model::machine::Supply;

/// A place that stores energy and through which energy flows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Place {
    /// Links and loads: kinetic and potential energy against the work of pressures, friction and weights. Several joints share
    /// one place, because links pass energy on to each other.
    Motion,
    /// Oil of a cylinder's cap side, \[A\] Eq. 2: inflow against the displacement of the piston.
    CapContinuity(usize),
    /// Oil of a cylinder's rod side.
    RodContinuity(usize),
    /// Oil of the pump line.
    PumpContinuity,
}

impl Place {
    /// All places of a model.
    pub fn all(model: &Model) -> Vec<Place> {
        let mut places = vec![Place::Motion];
        for (index, cylinder) in model.machine.cylinders.iter().enumerate() {
            if cylinder.chambers.is_some() {
                places.extend([Place::CapContinuity(index), Place::RodContinuity(index)]);
            }
        }
        if matches!(model.machine.supply, Supply::PumpLine(_)) {
            places.push(Place::PumpContinuity);
        }
        places
    }

    /// Index of the cylinder that the place belongs to; `None` for the pump line and for several joints together.
    pub fn cylinder(self, model: &Model) -> Option<usize> {
        match self {
            Place::Motion => (model.machine.cylinders.len() == 1).then_some(0),
            Place::CapContinuity(index) | Place::RodContinuity(index) => Some(index),
            Place::PumpContinuity => None,
        }
    }

    /// Name of the equation: `arm.motion`, `arm.cap_continuity`, `pump.continuity`.
    pub fn equation(self, model: &Model) -> String {
        let name = |index: usize| model.machine.cylinders.get(index).map_or("?", |cylinder| cylinder.name.as_str());
        match self {
            Place::Motion => {
                let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
                format!("{}.motion", names.join("+"))
            }
            Place::CapContinuity(index) => format!("{}.cap_continuity", name(index)),
            Place::RodContinuity(index) => format!("{}.rod_continuity", name(index)),
            Place::PumpContinuity => "pump.continuity".to_string(),
        }
    }
}
