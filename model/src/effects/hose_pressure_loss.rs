//! Pressure loss between valve and chamber.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Pressure loss between valve and chamber.
///
/// A hose in series with a metering edge: the edge gets the pressure drop that remains after the hose. For turbulent flow
/// both drops grow with the square of the flow, so they combine into one edge, and the pressures between them need no state.
/// It is the second form of \[B\] Eq. 17-18. The first, [`super::hose_loss`], is a force on the piston, which is the same
/// loss only if chamber pressures are measured at the valve. Flow that `valve_directional_gain` adds to an edge is not
/// throttled by the hose.
pub struct HosePressureLoss;

static CARD: Card = Card {
    name: text("hose_pressure_loss"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Candidate,
    summary: text(
        "The hose between valve and chamber takes pressure in proportion to the square of the flow, before the sensor at the chamber.",
    ),
    equation: text("q = C a sqrt(dp) / sqrt(1 + R (C a)^2) for each metering edge, from dp = R q^2 + (q / (C a))^2"),
    source: text("[B] Eq. 17-18, as a pressure loss"),
    shows: text(
        "Flow over sqrt(dp) against opening bends down at large openings, on both sides of the cylinder. A bent area law of the valve looks much the same: a look at hose and couplings tells them apart.",
    ),
    experiment: text("Steady strokes from small openings to the largest."),
    energy: text("Dissipates R q^3, booked with the metering edge that it is in series with."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("hose_resistance"),
    symbol: text("R"),
    unit: text("Pa s2/m6"),
    meaning: text("pressure loss per square of the flow, in each of the two hoses"),
    kind: Kind::Shape,
    growth: Growth::FLOW_RESISTANCE,
    minimum: 0.0,
    maximum: 1e15,
    typical: 1e12,
    start: Start::at(&[1e11]),
    prior: None,
}];

impl Physics for HosePressureLoss {
    fn card(&self) -> &Card {
        &CARD
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
        now.pistons[cylinder].hose_resistance = Some(parameters[0]);
    }
}
