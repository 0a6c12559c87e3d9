//! Viscous damping of the piston.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Viscous damping of the piston.
pub struct ViscousDamping;

static CARD: Card = Card {
    name: text("viscous_damping"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Loss,
    summary: text("Friction force that grows with speed."),
    equation: text("force -Fd v"),
    source: text("[A] Eq. 1, [B] Eq. 5"),
    shows: text("Force error in proportion to speed."),
    experiment: text("Steady strokes at several speeds."),
    energy: text("Dissipates Fd v^2."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("viscous_damping"),
    symbol: text("Fd"),
    unit: text("N s/m"),
    meaning: text("damping coefficient"),
    kind: Kind::Linear,
    growth: Growth::DAMPING,
    minimum: 0.0,
    maximum: 1e7,
    typical: 1e4,
    start: Start::at(&[1e4]),
    prior: None,
}];

impl Physics for ViscousDamping {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        rows.piston_force[cylinder] -= piston.warmth.oil.dragging(parameters[0]) * piston.velocity;
    }
}
