//! A pump drive whose flows match the areas of its cylinder.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A pump drive that takes less oil from the rod side than it gives the cap side: two pumps on one shaft, or a pump with unequal
/// ports.
///
/// The charge line then has little to make up, so the side at lower pressure is not held at charge pressure: its oil is trapped.
pub struct MatchedPumpFlow;

static CARD: Card = Card {
    name: text("matched_pump_flow"),
    acts_on: ActsOn::Valve,
    needs: Needs::Pump,
    family: Family::Candidate,
    summary: text(
        "The pump takes less oil from the rod side than it gives the cap side, as the areas of the cylinder ask.",
    ),
    equation: text("Q- = -(k - m) u beside Q+ = k u of the pump; m = k (1 - A-/A+) matches the areas"),
    source: text(
        "hydraulics practice (two pumps on one shaft, pumps with three ports); see Ketelsen et al. 2019, Energies 12, 1293",
    ),
    shows: text(
        "Both pressures float with the oil that is trapped, and nothing holds the lower one at charge pressure.",
    ),
    experiment: text(
        "Drive to an end stop and back: the lower pressure before and after differs by what passed the charge valve.",
    ),
    energy: text("Supplies b (exp(p/b) - 1) Q to the rod side, from the shaft of the pump."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("matched_flow_share"),
    symbol: text("m"),
    unit: text("-"),
    meaning: text("flow that is not drawn from the rod side, over speed times displacement"),
    kind: Kind::Linear,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 1.0,
    typical: 0.3,
    start: Start::at(&[0.15, 0.5]),
    prior: None,
}];

impl Physics for MatchedPumpFlow {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn why_not(&self, machine: &Machine, site: Site) -> Option<String> {
        let Site::Cylinder(cylinder) = site else { return None };
        let chambers = machine.cylinders.get(cylinder)?.chambers?;
        (chambers.cap_area <= chambers.rod_area)
            .then(|| "both sides have the same area, so that the flows of one pump match".to_string())
    }

    fn takes_power_from_a_shaft(&self) -> bool {
        true
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        rows.rod_flow[cylinder] += parameters[0] * now.pistons[cylinder].opening;
    }
}
