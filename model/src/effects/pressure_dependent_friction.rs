//! Friction of seals that pressure presses against the wall.

use super::{
    ActsOn, Card, Corner, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text,
};
use crate::equations::Situation;
use crate::machine::Machine;

/// Friction of seals that pressure presses against the wall.
pub struct PressureDependentFriction;

static CARD: Card = Card {
    name: text("pressure_dependent_friction"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Pressures,
    family: Family::Candidate,
    summary: text("Friction grows with the pressures in the chambers."),
    equation: text(
        "force -mu (max(0, p+) + max(0, p-)) sgn(v), the sign rounded (friction_reversal); a chamber under vacuum pushes no seal",
    ),
    source: text("textbook (e.g. Merritt, Watton)"),
    shows: text(
        "Force step at each reversal is larger under load than without; Coulomb friction identified at two pressure levels differs.",
    ),
    experiment: text("Slow reversals with and without load, or at two counter-pressures."),
    energy: text("Dissipates mu (p+ + p-) |v|."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("pressure_friction"),
    symbol: text("mu"),
    unit: text("m2"),
    meaning: text("friction force per sum of the chamber pressures"),
    kind: Kind::Linear,
    growth: Growth::FORCE,
    minimum: 0.0,
    maximum: 1e-2,
    typical: 1e-4,
    start: Start::at(&[5e-5]),
    prior: None,
}];

impl Physics for PressureDependentFriction {
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
        let pressing = piston.cap_pressure.positive_part() + piston.rod_pressure.positive_part();
        rows.piston_force[cylinder] -= piston.rubbing(parameters[0]) * pressing * piston.direction();
    }
}
