//! Pressure compensator in front of the metering edges.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Pressure compensator in front of the metering edges.
///
/// The data sheet shows whether a section has one, and its margin is the setting of a spring. It is not a candidate of a
/// diagnosis: a margin within the pressure drops of a recording is a knee that absorbs the errors of a nonlinear gain, a relief
/// valve or a leaking pump, and a margin above them has no effect. Add it by hand, as `pressure_compensation@arm`, and compare.
///
/// A load-sensing pump holds a standby pressure where no load asks for more. At a low load the edge then gets more than its margin.
pub struct PressureCompensation;

static CARD: Card = Card {
    name: text("pressure_compensation"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Construction,
    summary: text(
        "A compensator between pump and metering edge limits the edge's pressure drop to its margin, so the opening sets the flow.",
    ),
    equation: text(
        "flow from the pump Cf u phi(x), x = d / (1 + (d/p)^8)^(1/8) for a drop d > 0, p = max(pm, p0 - p_load): the orifice law well below p, Cf u sqrt(p) well above; edges to tank keep the orifice law",
    ),
    source: text("hydraulics practice (pressure-compensated mobile valves); textbook (e.g. Merritt; Murrenhoff)"),
    shows: text(
        "Speed follows the opening whatever the load, until pump pressure is within the margin of the load's; then it falls as with any orifice.",
    ),
    experiment: text("The same opening against different loads, and once with the pump near its lowest pressure."),
    energy: text("Throttles what the edge would not: its loss is part of the metering loss."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("compensator_margin"),
        symbol: text("pm"),
        unit: text("Pa"),
        meaning: text("pressure drop that the compensator leaves to the metering edge"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e5,
        maximum: 5e6,
        typical: 1e6,
        start: Start::at(&[7e5, 2e6]),
        prior: None,
    },
    ParameterCard {
        name: text("standby_pressure"),
        symbol: text("p0"),
        unit: text("Pa"),
        meaning: text("lowest pressure that the pump keeps in front of the metering edge"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 0.0,
        maximum: 5e6,
        typical: 0.0,
        start: Start::at(&[0.0]),
        prior: None,
    },
];

impl Physics for PressureCompensation {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn value_where_left_out(&self, parameter: &str) -> Option<f64> {
        (parameter == "standby_pressure").then_some(0.0)
    }

    fn has_power(&self) -> bool {
        false
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &mut now.pistons[cylinder];
        let load = if piston.opening.value() >= 0.0 { piston.cap_pressure } else { piston.rod_pressure };
        let [margin, standby] = [parameters[0], parameters[1]];
        piston.compensator_margin = Some(margin + (standby - load - margin).positive_part());
    }
}
