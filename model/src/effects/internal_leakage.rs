//! Leakage past the piston seal.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage past the piston seal.
pub struct InternalLeakage;

static CARD: Card = Card {
    name: text("internal_leakage"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Loss,
    summary: text("Laminar leakage from one chamber to the other."),
    equation: text("Q+ = -Ci (p+ - p-), Q- = +Ci (p+ - p-)"),
    source: text("[A] Eq. 1"),
    shows: text("Pressures run together while the valve is closed."),
    experiment: text("Holds with a loaded cylinder."),
    energy: text("Dissipates b Ci (p+ - p-) (exp(p+/b) - exp(p-/b))."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("internal_leakage"),
    symbol: text("Ci"),
    unit: text("m3/(s Pa)"),
    meaning: text("leakage coefficient"),
    kind: Kind::Linear,
    growth: Growth::FLOW,
    minimum: 0.0,
    maximum: 1e-6,
    typical: 1e-11,
    start: Start::at(&[1e-11]),
    prior: None,
}];

impl Physics for InternalLeakage {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let flow = piston.warmth.oil.leaking(parameters[0]) * (piston.cap_pressure - piston.rod_pressure);
        rows.cap_flow[cylinder] -= flow;
        rows.rod_flow[cylinder] += flow;
    }
}
