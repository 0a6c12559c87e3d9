//! Coulomb friction of the piston.

use super::{
    ActsOn, Card, Corner, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text,
};
use crate::equations::Situation;
use crate::machine::Machine;

/// Coulomb friction of the piston.
pub struct CoulombFriction;

static CARD: Card = Card {
    name: text("coulomb_friction"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Loss,
    summary: text("Friction force of constant size against the motion."),
    equation: text("force -Fc sgn(v), the sign rounded (friction_reversal)"),
    source: text(
        "[A] Eq. 1. Eq. 11 of [A] prints its power with G22 squared, which has the wrong unit; -Fc |v| \
        follows from Eq. 1.",
    ),
    shows: text("Force step at each reversal."),
    experiment: text("Slow reversals."),
    energy: text("Dissipates Fc |v|."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("coulomb_friction"),
    symbol: text("Fc"),
    unit: text("N"),
    meaning: text("friction force"),
    kind: Kind::Linear,
    growth: Growth::FORCE,
    minimum: 0.0,
    maximum: 1e6,
    typical: 200.0,
    start: Start::at(&[200.0]),
    prior: None,
}];

impl Physics for CoulombFriction {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn corner(&self, parameters: &[f64]) -> Option<Corner> {
        // A friction of zero has no corner.
        parameters.first().is_some_and(|level| *level > 0.0).then_some(Corner::Friction)
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        rows.piston_force[cylinder] -= piston.rubbing(parameters[0]) * piston.direction();
    }
}
