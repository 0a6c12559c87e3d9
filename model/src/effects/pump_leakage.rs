//! Leakage inside the pump.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage inside the pump.
pub struct PumpLeakage;

static CARD: Card = Card {
    name: text("pump_leakage"),
    acts_on: ActsOn::PumpLine,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text("The pump gives less flow the higher its pressure."),
    equation: text("pump line loses kp pp"),
    source: text("textbook (e.g. Merritt: slip flow of positive displacement pumps)"),
    shows: text("Flow missing in the pump line in proportion to its pressure, whatever the spools do."),
    experiment: text("Hold the spool at several openings against a load, so that pump pressure takes several levels."),
    energy: text("Throttled between pump and tank, outside the cylinders."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("pump_leakage"),
    symbol: text("kp"),
    unit: text("m3/(s Pa)"),
    meaning: text("flow lost per pressure"),
    kind: Kind::Linear,
    growth: Growth::FLOW,
    minimum: 0.0,
    maximum: 1e-8,
    typical: 1e-11,
    start: Start::at(&[1e-12]),
    prior: None,
}];

impl Physics for PumpLeakage {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, _site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        rows.pump_flow -= parameters[0] * now.pump_pressure;
    }
}
