//! Viscous damping of the piston.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start};
use crate::equations::Situation;
use crate::machine::Machine;

/// Viscous damping of the piston.
pub struct ViscousDamping;

static CARD: Card = Card {
    name: "viscous_damping",
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Loss,
    summary: "Friction force that grows with speed.",
    equation: "force -Fd v",
    source: "[A] Eq. 1, [B] Eq. 5",
    shows: "Force error in proportion to speed.",
    experiment: "Steady strokes at several speeds.",
    energy: "Dissipates Fd v^2.",
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: "viscous_damping",
    symbol: "Fd",
    unit: "N s/m",
    meaning: "damping coefficient",
    kind: Kind::Linear,
    minimum: 0.0,
    maximum: 1e7,
    typical: 1e4,
    start: Start::At(&[1e4]),
    prior: None,
}];

impl Physics for ViscousDamping {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        rows.piston_force[cylinder] -= parameters[0] * piston.velocity;
    }
}
