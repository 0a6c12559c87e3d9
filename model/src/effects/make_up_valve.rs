//! Make-up valves: oil from the tank line fills a chamber whose pressure drops too low.

use super::cavitation::fill_below;
use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Make-up valves: a check valve from the tank line to each chamber.
pub struct MakeUpValve;

static CARD: Card = Card {
    name: text("make_up_valve"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text(
        "A check valve lets oil from the tank line into a chamber that is drawn below its pressure: the load runs ahead without the chamber boiling.",
    ),
    equation: text("Q+ = k max(0, pt - pm - p+), likewise on the rod side"),
    source: text("textbook (e.g. Merritt, Hydraulic Control Systems): anti-cavitation check valves"),
    shows: text("A chamber pressure that rests at a floor near the tank's while the piston runs ahead of the oil."),
    experiment: text("Lower a load fast, or brake it hard against a closing valve."),
    energy: text(
        "Supplies oil at the chamber's pressure; what it lost on the way from tank pressure is outside the cylinders.",
    ),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("make_up_cracking"),
        symbol: text("pm"),
        unit: text("Pa"),
        meaning: text("how far below tank pressure a chamber must be drawn for its valve to open"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 0.0,
        maximum: 2e6,
        typical: 2e4,
        start: Start::at(&[2e4, 1e5]),
        prior: None,
    },
    ParameterCard {
        name: text("make_up_valve_gain"),
        symbol: text("k"),
        unit: text("m3/(s Pa)"),
        meaning: text("flow per pressure beyond cracking"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 3e-9,
        start: Start::at(&[3e-10]),
        prior: None,
    },
];

impl Physics for MakeUpValve {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        fill_below(now.tank_pressure - parameters[0], parameters[1], site, now, rows);
    }
}
