//! Leakage out of the chambers.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage out of the chambers.
pub struct ExternalLeakage;

static CARD: Card = Card {
    name: "external_leakage",
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Loss,
    summary: "Laminar leakage from each chamber to the outside.",
    equation: "Q+ = -Ce+ p+, Q- = -Ce- p-",
    source: "[A] Eq. 1",
    shows: "Pressures fall towards ambient while the valve is closed.",
    experiment: "Long holds.",
    energy: "Dissipates b (Ce+ p+ (exp(p+/b) - 1) + Ce- p- (exp(p-/b) - 1)).",
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: "external_leakage_cap",
        symbol: "Ce+",
        unit: "m3/(s Pa)",
        meaning: "leakage coefficient of the cap side",
        kind: Kind::Linear,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 3e-12,
        start: Start::At(&[3e-12]),
        prior: None,
    },
    ParameterCard {
        name: "external_leakage_rod",
        symbol: "Ce-",
        unit: "m3/(s Pa)",
        meaning: "leakage coefficient of the rod side",
        kind: Kind::Linear,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 3e-12,
        start: Start::At(&[3e-12]),
        prior: None,
    },
];

impl Physics for ExternalLeakage {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        rows.cap_flow[cylinder] -= parameters[0] * piston.cap_pressure;
        rows.rod_flow[cylinder] -= parameters[1] * piston.rod_pressure;
    }
}
