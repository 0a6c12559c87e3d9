//! A constant part of the resisting force.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start};
use crate::equations::Situation;
use crate::machine::Machine;

/// A constant part of the resisting force.
pub struct ForceOffset;

static CARD: Card = Card {
    name: "force_offset",
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Base,
    summary: "Constant resisting force: offset of the force measurement or friction that differs by \
        direction.",
    equation: "force -F0, that is: measured force = M a + Fd v + Fc sgn(v) + F0",
    source: "Janot, Gautier, Brunot 2019 (EMPS benchmark)",
    shows: "Force error that is the same at all speeds and positions.",
    experiment: "Slow strokes in both directions.",
    energy: "Exchanges F0 v.",
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: "force_offset",
    symbol: "F0",
    unit: "N",
    meaning: "constant resisting force",
    kind: Kind::Linear,
    minimum: -1e6,
    maximum: 1e6,
    typical: 10.0,
    start: Start::At(&[0.0]),
    prior: None,
}];

impl Physics for ForceOffset {
    fn card(&self) -> &'static Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &'static [ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let _ = now;
        rows.piston_force[cylinder] -= parameters[0];
    }
}
