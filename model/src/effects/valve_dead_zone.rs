//! Overlap of the spool.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Overlap of the spool.
pub struct ValveDeadZone;

static CARD: Card = Card {
    name: text("valve_dead_zone"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text("No flow until the spool has travelled past its overlap."),
    equation: text("opening = u - dz+ for u > dz+, u + dz- for u < -dz-, else 0: the area past the edge counts"),
    source: text("[B] IV-B"),
    shows: text("Flow over root of the pressure drop against opening: a gap around zero, then a parallel line."),
    experiment: text("Slow small trapezoids around closed."),
    energy: text("Changes the supply through the valve; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("dead_zone_positive"),
        symbol: text("dz+"),
        unit: text("m2"),
        meaning: text("overlap towards the cap side"),
        kind: Kind::Shape,
        growth: Growth::OPENING,
        minimum: 0.0,
        maximum: 1e-4,
        typical: 1e-5,
        start: Start::at(&[3e-6]),
        prior: None,
    },
    ParameterCard {
        name: text("dead_zone_negative"),
        symbol: text("dz-"),
        unit: text("m2"),
        meaning: text("overlap towards the rod side"),
        kind: Kind::Shape,
        growth: Growth::OPENING,
        minimum: 0.0,
        maximum: 1e-4,
        typical: 1e-5,
        start: Start::at(&[3e-6]),
        prior: None,
    },
];

impl Physics for ValveDeadZone {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    /// A valve that never leaves its dead zone passes no oil.
    fn plausible(&self, machine: &Machine, site: Site, _parameter: &str) -> Option<[f64; 2]> {
        let Site::Cylinder(cylinder) = site else { return None };
        let chambers = machine.cylinders.get(cylinder)?.chambers?;
        Some([0.0, chambers.full_command()])
    }

    fn has_power(&self) -> bool {
        false
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn opening<T: Scalar>(&self, _site: Site, parameters: &[T], opening: T, _now: &Situation<T>) -> T {
        (opening - parameters[0]).positive_part() - (-opening - parameters[1]).positive_part()
    }
}
