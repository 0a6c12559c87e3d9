//! A constant part of the resisting force.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// A constant part of the resisting force.
pub struct ForceOffset;

static CARD: Card = Card {
    name: text("force_offset"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Base,
    summary: text(
        "Constant resisting force: offset of the force measurement or friction that differs by \
        direction.",
    ),
    equation: text("force -F0, that is: measured force = M a + Fd v + Fc sgn(v) + F0"),
    source: text("Janot, Gautier, Brunot 2019 (EMPS benchmark)"),
    shows: text("Force error that is the same at all speeds and positions."),
    experiment: text("Slow strokes in both directions."),
    energy: text("Exchanges F0 v."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("force_offset"),
    symbol: text("F0"),
    unit: text("N"),
    meaning: text("constant resisting force"),
    kind: Kind::Linear,
    growth: Growth::FORCE,
    minimum: -1e6,
    maximum: 1e6,
    typical: 10.0,
    start: Start::at(&[0.0]),
    prior: None,
}];

impl Physics for ForceOffset {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let _ = now;
        rows.piston_force[cylinder] -= parameters[0];
    }
}
