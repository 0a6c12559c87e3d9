//! Check valves from the charge line of a closed circuit.

use super::cavitation::fill_below;
use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Check valves from the charge line, which fill a chamber whose pressure is below the charge pressure.
pub struct ChargeCheckValve;

static CARD: Card = Card {
    name: text("charge_check_valve"),
    acts_on: ActsOn::Valve,
    needs: Needs::Pump,
    family: Family::Construction,
    summary: text("Check valves let oil from the charge line into a chamber below its pressure."),
    equation: text("Q+ = k max(0, pp - p+), likewise on the rod side, pp the pressure of the supply"),
    source: text("hydraulics practice (closed circuits with boost); textbook (e.g. Merritt)"),
    shows: text("The side that is not loaded rests at charge pressure."),
    experiment: text("Drive against a load in both directions."),
    energy: text("Throttles between charge line and chamber."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("charge_valve_gain"),
    symbol: text("k"),
    unit: text("m3/(s Pa)"),
    meaning: text("flow per pressure beyond the charge line"),
    kind: Kind::Linear,
    growth: Growth::FLOW,
    minimum: 0.0,
    maximum: 1e-5,
    typical: 1e-9,
    start: Start::at(&[1e-9]),
    prior: None,
}];

impl Physics for ChargeCheckValve {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let before = rows.cap_flow[cylinder] + rows.rod_flow[cylinder];
        fill_below(now.pump_pressure, parameters[0], site, now, rows);
        rows.pump_flow -= rows.cap_flow[cylinder] + rows.rod_flow[cylinder] - before;
    }
}
