//! Leakage past the piston seal.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage past the piston seal.
pub struct InternalLeakage;

static CARD: Card = Card {
    name: "internal_leakage",
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Loss,
    summary: "Laminar leakage from one chamber to the other.",
    equation: "Q+ = -Ci (p+ - p-), Q- = +Ci (p+ - p-)",
    source: "[A] Eq. 1",
    shows: "Pressures run together while the valve is closed.",
    experiment: "Holds with a loaded cylinder.",
    energy: "Dissipates b Ci (p+ - p-) (exp(p+/b) - exp(p-/b)).",
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: "internal_leakage",
    symbol: "Ci",
    unit: "m3/(s Pa)",
    meaning: "leakage coefficient",
    kind: Kind::Linear,
    minimum: 0.0,
    maximum: 1e-6,
    typical: 1e-11,
    start: Start::At(&[1e-11]),
    prior: None,
}];

impl Physics for InternalLeakage {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let flow = parameters[0] * (piston.cap_pressure - piston.rod_pressure);
        rows.cap_flow[cylinder] -= flow;
        rows.rod_flow[cylinder] += flow;
    }
}
