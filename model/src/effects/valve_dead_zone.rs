//! Overlap of the spool.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start};
use crate::machine::Machine;

/// Overlap of the spool.
pub struct ValveDeadZone;

static CARD: Card = Card {
    name: "valve_dead_zone",
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: "No flow until the spool has travelled past its overlap.",
    equation: "opening = u - dz+ for u > dz+, u + dz- for u < -dz-, else 0: the area past the edge counts",
    source: "[B] IV-B",
    shows: "Flow over root of the pressure drop against opening: a gap around zero, then a parallel line.",
    experiment: "Slow small trapezoids around closed.",
    energy: "Changes the supply through the valve; dissipates nothing itself.",
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: "dead_zone_positive",
        symbol: "dz+",
        unit: "m2",
        meaning: "overlap towards the cap side",
        kind: Kind::Shape,
        minimum: 0.0,
        maximum: 1e-4,
        typical: 1e-5,
        start: Start::At(&[3e-6]),
        prior: None,
    },
    ParameterCard {
        name: "dead_zone_negative",
        symbol: "dz-",
        unit: "m2",
        meaning: "overlap towards the rod side",
        kind: Kind::Shape,
        minimum: 0.0,
        maximum: 1e-4,
        typical: 1e-5,
        start: Start::At(&[3e-6]),
        prior: None,
    },
];

impl Physics for ValveDeadZone {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn opening<T: Scalar>(&self, parameters: &[T], opening: T, _maximum: f64) -> T {
        (opening - parameters[0]).positive_part() - (-opening - parameters[1]).positive_part()
    }
}
