//! Turbulent flow through the metering edges of the valve.

use super::{
    ActsOn, Card, Corner, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text,
};
use crate::equations::Situation;
use crate::machine::Machine;

/// Turbulent flow through the metering edges of the valve.
pub struct OrificeFlow;

static CARD: Card = Card {
    name: text("orifice_flow"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Base,
    summary: text("Flow through the open metering edges."),
    equation: text(
        "u > 0: Q+ = Cf+ u phi(pp - p+), Q- = -Cf- u phi(p- - pt), pump gives Q+; u < 0: Q+ = Cf+ u \
        phi(p+ - pt), Q- = -Cf- u phi(pp - p-), pump gives Q-; phi(x) = sgn(x) sqrt|x|, laminar below 2 \
        kPa",
    ),
    source: text(
        "[A] Eq. 1, 3. For u < 0 Eq. 3 prints the flow drawn from the pump as negative; phi carries a \
        sign so that flow reverses when the supply is below the chamber.",
    ),
    shows: text("Speed against opening times root of the pressure drop."),
    experiment: text("Trapezoids of several amplitudes."),
    energy: text("Supplies b (exp(p/b) - 1) Q to each chamber."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("flow_gain_cap"),
        symbol: text("Cf+"),
        unit: text("m/(s sqrt(Pa))"),
        meaning: text("flow gain of the cap side edges"),
        kind: Kind::Linear,
        growth: Growth::FLOW_GAIN,
        minimum: 0.0,
        maximum: 1.0,
        typical: 4e-3,
        start: Start::at(&[4e-3]),
        prior: None,
    },
    ParameterCard {
        name: text("flow_gain_rod"),
        symbol: text("Cf-"),
        unit: text("m/(s sqrt(Pa))"),
        meaning: text("flow gain of the rod side edges"),
        kind: Kind::Linear,
        growth: Growth::FLOW_GAIN,
        minimum: 0.0,
        maximum: 1.0,
        typical: 4e-3,
        start: Start::at(&[4e-3]),
        prior: None,
    },
];

impl Physics for OrificeFlow {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn corner(&self, _parameters: &[f64]) -> Option<Corner> {
        Some(Corner::OrificeFlow)
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let (tank, pump) = (now.tank_pressure, now.pump_pressure);
        let [cap_opening, rod_opening] = piston.edges();
        let cap_gain = piston.with_hose(parameters[0] * cap_opening);
        let rod_gain = piston.with_hose(parameters[1] * rod_opening);
        if piston.opening.value() >= 0.0 {
            let drawn = cap_gain * piston.drawn_root(pump - piston.cap_pressure);
            rows.cap_flow[cylinder] += drawn;
            rows.rod_flow[cylinder] -= rod_gain * piston.root(piston.rod_pressure - tank);
            rows.pump_flow -= drawn;
        } else {
            let drawn = -rod_gain * piston.drawn_root(pump - piston.rod_pressure);
            rows.cap_flow[cylinder] += cap_gain * piston.root(piston.cap_pressure - tank);
            rows.rod_flow[cylinder] += drawn;
            rows.pump_flow -= drawn;
        }
    }
}
