//! Leakage out of the chambers.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Leakage out of the chambers.
pub struct ExternalLeakage;

static CARD: Card = Card {
    name: text("external_leakage"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Loss,
    summary: text("Laminar leakage from each chamber to the outside."),
    equation: text("Q+ = -Ce+ p+, Q- = -Ce- p-"),
    source: text("[A] Eq. 1"),
    shows: text("Pressures fall towards ambient while the valve is closed."),
    experiment: text("Long holds."),
    energy: text("Dissipates b (Ce+ p+ (exp(p+/b) - 1) + Ce- p- (exp(p-/b) - 1))."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("external_leakage_cap"),
        symbol: text("Ce+"),
        unit: text("m3/(s Pa)"),
        meaning: text("leakage coefficient of the cap side"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 3e-12,
        start: Start::at(&[3e-12]),
        prior: None,
    },
    ParameterCard {
        name: text("external_leakage_rod"),
        symbol: text("Ce-"),
        unit: text("m3/(s Pa)"),
        meaning: text("leakage coefficient of the rod side"),
        kind: Kind::Linear,
        growth: Growth::FLOW,
        minimum: 0.0,
        maximum: 1e-6,
        typical: 3e-12,
        start: Start::at(&[3e-12]),
        prior: None,
    },
];

impl Physics for ExternalLeakage {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let [cap, rod] = [parameters[0], parameters[1]].map(|coefficient| piston.warmth.oil.leaking(coefficient));
        rows.cap_flow[cylinder] -= cap * piston.cap_pressure;
        rows.rod_flow[cylinder] -= rod * piston.rod_pressure;
    }
}
