//! Leakage inside the pump.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage inside the pump.
pub struct PumpLeakage;

static CARD: Card = Card {
    name: "pump_leakage",
    acts_on: ActsOn::PumpLine,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: "The pump gives less flow the higher its pressure.",
    equation: "pump line loses kp pp",
    source: "textbook (e.g. Merritt: slip flow of positive displacement pumps)",
    shows: "Flow missing in the pump line in proportion to its pressure, whatever the spools do.",
    experiment: "Hold the spool at several openings against a load, so that pump pressure takes several levels.",
    energy: "Throttled between pump and tank, outside the cylinders.",
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: "pump_leakage",
    symbol: "kp",
    unit: "m3/(s Pa)",
    meaning: "flow lost per pressure",
    kind: Kind::Linear,
    minimum: 0.0,
    maximum: 1e-8,
    typical: 1e-11,
    start: Start::At(&[1e-12]),
    prior: None,
}];

impl Physics for PumpLeakage {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, _site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        rows.pump_flow -= parameters[0] * now.pump_pressure;
    }
}
