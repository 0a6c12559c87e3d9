//! Relief valve of the pump line.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Relief valve of the pump line.
pub struct ReliefValve;

static CARD: Card = Card {
    name: text("relief_valve"),
    acts_on: ActsOn::PumpLine,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text("Opens above its cracking pressure and returns flow to tank."),
    equation: text("pump line loses k max(0, pp - pr)"),
    source: text("[A] 3.2, [B] II"),
    shows: text("Pump pressure stays under a ceiling although the bypass is shut."),
    experiment: text("Full opening against a load until the pressure levels off."),
    energy: text("Throttled between pump and tank, outside the cylinders."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("relief_pressure"),
        symbol: text("pr"),
        unit: text("Pa"),
        meaning: text("cracking pressure"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e5,
        maximum: 1e8,
        typical: 2e6,
        start: Start::pump_pressure_quantiles(&[0.97, 0.85]),
        prior: None,
    },
    ParameterCard {
        name: text("relief_gain"),
        symbol: text("k"),
        unit: text("m3/(s Pa)"),
        meaning: text("flow per pressure above cracking"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 1e-9,
        start: Start::at(&[3e-10]),
        prior: None,
    },
];

impl Physics for ReliefValve {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, _site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        rows.pump_flow -= (now.pump_pressure - parameters[0]).positive_part() * parameters[1];
    }
}
