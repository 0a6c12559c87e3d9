//! A gain for each metering edge that changes with the opening.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A gain for each metering edge that changes with the opening: the four polynomials of \[B\] Fig. 4.
///
/// The constant parts are those of `orifice_flow` and `valve_directional_gain`. Each edge adds a linear and a quadratic part, so that
/// the rows stay linear and zero is the model without them.
pub struct ValveEdgeCurves;

static CARD: Card = Card {
    name: text("valve_edge_curves"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Construction,
    summary: text("Each of the four metering edges has a flow gain of its own that changes with the opening."),
    equation: text(
        "adds (a x + b x^2) u phi(drop) to the flow of each edge, x = |u|/umax: pump to cap and rod to tank for u > 0, cap to tank and pump to rod for u < 0",
    ),
    source: text("[B] Eq. 7-8, 11, and Fig. 4 (polynomials of the opening)"),
    shows: text("Speed over opening times root of the pressure drop bends with opening, for each edge in its own way."),
    experiment: text("Trapezoids of many amplitudes in both directions, up to the full opening."),
    energy: text("Supplies b (exp(p/b) - 1) times its flow to each chamber."),
};

macro_rules! part {
    ($name:literal, $symbol:literal, $meaning:literal) => {
        ParameterCard {
            name: text($name),
            symbol: text($symbol),
            unit: text("m/(s sqrt(Pa))"),
            meaning: text($meaning),
            kind: Kind::Linear,
            growth: Growth::FLOW_GAIN,
            minimum: -0.02,
            maximum: 0.02,
            typical: 1e-3,
            start: Start::at(&[0.0]),
            prior: None,
        }
    };
}

static PARAMETERS: &[ParameterCard] = &[
    part!("edge_pump_cap_first", "a1+", "linear change of the gain from pump to cap side, at full opening"),
    part!("edge_pump_cap_second", "b1+", "quadratic change of the gain from pump to cap side, at full opening"),
    part!("edge_rod_tank_first", "a2+", "linear change of the gain from rod side to tank, at full opening"),
    part!("edge_rod_tank_second", "b2+", "quadratic change of the gain from rod side to tank, at full opening"),
    part!("edge_cap_tank_first", "a1-", "linear change of the gain from cap side to tank, at full opening"),
    part!("edge_cap_tank_second", "b1-", "quadratic change of the gain from cap side to tank, at full opening"),
    part!("edge_pump_rod_first", "a2-", "linear change of the gain from pump to rod side, at full opening"),
    part!("edge_pump_rod_second", "b2-", "quadratic change of the gain from pump to rod side, at full opening"),
];

impl Physics for ValveEdgeCurves {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let (tank, pump) = (now.tank_pressure, now.pump_pressure);
        let [cap_opening, rod_opening] = piston.edges();
        let travel = piston.opening.abs() / now.largest_opening(site);
        let gain = |first: usize, opening: T| travel * (parameters[first] + parameters[first + 1] * travel) * opening;
        if piston.opening.value() >= 0.0 {
            let drawn = gain(0, cap_opening) * piston.drawn_root(pump - piston.cap_pressure);
            rows.cap_flow[cylinder] += drawn;
            rows.rod_flow[cylinder] -= gain(2, rod_opening) * piston.root(piston.rod_pressure - tank);
            rows.pump_flow -= drawn;
        } else {
            let drawn = -gain(6, rod_opening) * piston.drawn_root(pump - piston.rod_pressure);
            rows.cap_flow[cylinder] += gain(4, cap_opening) * piston.root(piston.cap_pressure - tank);
            rows.rod_flow[cylinder] += drawn;
            rows.pump_flow -= drawn;
        }
    }
}
