//! Friction that differs by direction.

use super::{
    ActsOn, Card, Corner, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text,
};
use crate::equations::Situation;
use crate::machine::Machine;

/// Friction that differs by direction.
///
/// The level of retraction is that of `coulomb_friction`. Each direction scales the same curve of speed, so a creeping piston
/// gets the same fraction of its level as with `coulomb_friction`.
pub struct AsymmetricFriction;

static CARD: Card = Card {
    name: text("asymmetric_friction"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text(
        "The friction level of extension differs from that of retraction: lip seals, a bent rod, a wiper that bites one way.",
    ),
    equation: text(
        "force -dFc max(s, 0), s = sgn(v) rounded (friction_reversal): dFc more against extension, nothing against retraction",
    ),
    source: text("textbook (e.g. Armstrong-Helouvry, Dupont, Canudas de Wit 1994)"),
    shows: text("Force error of one size while extending and another while retracting, at any speed."),
    experiment: text("Slow strokes in both directions over the same range."),
    energy: text("Dissipates dFc |v| while extending."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("extension_friction_change"),
    symbol: text("dFc"),
    unit: text("N"),
    meaning: text("how much larger the friction of extension is than that of retraction"),
    kind: Kind::Linear,
    growth: Growth::FORCE,
    minimum: -1e5,
    maximum: 1e5,
    typical: 200.0,
    start: Start::at(&[0.0]),
    prior: None,
}];

impl Physics for AsymmetricFriction {
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
        rows.piston_force[cylinder] -= piston.rubbing(parameters[0]) * piston.direction().positive_part();
    }
}
