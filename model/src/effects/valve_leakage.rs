//! Leakage across the lands of the spool.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage across the lands of the spool.
pub struct ValveLeakage;

static CARD: Card = Card {
    name: text("valve_leakage"),
    acts_on: ActsOn::Valve,
    needs: Needs::Valve,
    family: Family::Candidate,
    summary: text("Laminar leakage between pump, chambers and tank across the spool's lands."),
    equation: text(
        "Q+ = Cpa (pp - p+) - Cat (p+ - pt), Q- = Cpb (pp - p-) - Cbt (p- - pt); the pump gives the \
        first term of each",
    ),
    source: text("[B] Eq. 12-13"),
    shows: text(
        "Chamber pressures move while the valve is closed; both drift towards a value between pump and \
        tank.",
    ),
    experiment: text("Holds of several seconds with the valve closed."),
    energy: text("Supplies or drains each chamber by flow times pressure."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("valve_leakage_pump_cap"),
        symbol: text("Cpa"),
        unit: text("m3/(s Pa)"),
        meaning: text("leakage pump to cap side"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-8,
        typical: 2e-11,
        start: Start::at(&[2e-12]),
        prior: None,
    },
    ParameterCard {
        name: text("valve_leakage_cap_tank"),
        symbol: text("Cat"),
        unit: text("m3/(s Pa)"),
        meaning: text("leakage cap side to tank"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-8,
        typical: 2e-11,
        start: Start::at(&[2e-12]),
        prior: None,
    },
    ParameterCard {
        name: text("valve_leakage_pump_rod"),
        symbol: text("Cpb"),
        unit: text("m3/(s Pa)"),
        meaning: text("leakage pump to rod side"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-8,
        typical: 2e-11,
        start: Start::at(&[2e-12]),
        prior: None,
    },
    ParameterCard {
        name: text("valve_leakage_rod_tank"),
        symbol: text("Cbt"),
        unit: text("m3/(s Pa)"),
        meaning: text("leakage rod side to tank"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-8,
        typical: 2e-11,
        start: Start::at(&[2e-12]),
        prior: None,
    },
];

impl Physics for ValveLeakage {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let (pump, tank) = (now.pump_pressure, now.tank_pressure);
        let leaking = |number: usize| piston.warmth.oil.leaking(parameters[number]);
        let pump_to_cap = leaking(0) * (pump - piston.cap_pressure);
        let pump_to_rod = leaking(2) * (pump - piston.rod_pressure);
        rows.cap_flow[cylinder] += pump_to_cap - leaking(1) * (piston.cap_pressure - tank);
        rows.rod_flow[cylinder] += pump_to_rod - leaking(3) * (piston.rod_pressure - tank);
        rows.pump_flow -= pump_to_cap + pump_to_rod;
    }
}
