//! Check valve between pump line and metering edge.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Check valve between pump line and metering edge.
///
/// The share is a parameter, not a switch, so that a fit can identify the backflow. The slope of the flow law jumps at
/// zero pressure drop; the flow itself does not.
pub struct LoadCheckValve;

static CARD: Card = Card {
    name: text("load_check_valve"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Candidate,
    summary: text(
        "No oil runs back from a chamber to the pump while the pump pressure is below the chamber's: the load does not sag as the valve opens.",
    ),
    equation: text("flow from pump to chamber times (1 - c) while the pump is below the chamber; c = 1: tight"),
    source: text("hydraulics practice (load holding check of mobile valve sections)"),
    shows: text(
        "With the valve just opened and the pump still low, the load stands still where the model lets it drop.",
    ),
    experiment: text("Open slowly from closed against a heavy load, from low pump pressure."),
    energy: text("Keeps oil from flowing back; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("check_tightness"),
    symbol: text("c"),
    unit: text("-"),
    meaning: text("share of the flow back that the check valve keeps: 0 none, 1 all"),
    kind: Kind::Linear,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 1.0,
    typical: 0.9,
    start: Start::at(&[0.5]),
    prior: None,
}];

impl Physics for LoadCheckValve {
    fn card(&self) -> &Card {
        &CARD
    }

    fn has_natural_maximum(&self, parameter: &str) -> bool {
        parameter == "check_tightness"
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        now.pistons[cylinder].backflow *= -parameters[0] + 1.0;
    }
}
