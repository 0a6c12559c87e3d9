//! A valve that connects the side at lower pressure to the charge line.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::equations::smooth::rounded_step;
use crate::machine::Machine;

/// A shuttle valve, or pilot-operated check valves: the side at lower pressure is open to the charge line, in both directions, so
/// that a cylinder of unequal areas can run in a closed circuit.
pub struct ShuttleValve;

static CARD: Card = Card {
    name: text("shuttle_valve"),
    acts_on: ActsOn::Valve,
    needs: Needs::Pump,
    family: Family::Construction,
    summary: text(
        "The side at lower pressure is open to the charge line, which makes up or takes the flow difference of unequal areas.",
    ),
    equation: text(
        "Q+ = k s(p- - p+) (pp - p+), Q- = k s(p+ - p-) (pp - p-), s(x) = 1/(1 + exp(-2 (x - po)/w)), w = 0.45 po + 10 kPa",
    ),
    source: text("hydraulics practice (inverse shuttle, pilot-operated check valves); textbook (e.g. Murrenhoff)"),
    shows: text(
        "The side at lower pressure stays at charge pressure while the piston moves either way; the sides change over where the load turns round.",
    ),
    experiment: text("Drive with the load pushing and with it pulling."),
    energy: text("Throttles between charge line and chamber."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("shuttle_opening_pressure"),
        symbol: text("po"),
        unit: text("Pa"),
        meaning: text("difference of the pressures at which the valve is half open"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 0.0,
        maximum: 2e6,
        typical: 2e5,
        start: Start::at(&[2e5]),
        prior: None,
    },
    ParameterCard {
        name: text("shuttle_gain"),
        symbol: text("k"),
        unit: text("m3/(s Pa)"),
        meaning: text("flow per pressure difference"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-5,
        typical: 1e-9,
        start: Start::at(&[1e-9]),
        prior: None,
    },
];

impl Physics for ShuttleValve {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let difference = piston.rod_pressure - piston.cap_pressure;
        let [opening, gain] = [parameters[0], parameters[1]];
        let width = opening * RAMP + SHARPEST;
        let cap = gain * rounded_step((difference - opening) / width) * (now.pump_pressure - piston.cap_pressure);
        let rod = gain * rounded_step((-difference - opening) / width) * (now.pump_pressure - piston.rod_pressure);
        rows.cap_flow[cylinder] += cap;
        rows.rod_flow[cylinder] += rod;
        rows.pump_flow -= cap + rod;
    }
}

/// Half width of the ramp over which the valve opens, as a fraction of the pressure at which it is half open. The spring force
/// grows by a factor of 2.6 from the first movement (0.55) to the fully open valve (1.45).
const RAMP: f64 = 0.45;

/// Half width of the ramp of a valve without a spring, Pa.
const SHARPEST: f64 = 1e4;
