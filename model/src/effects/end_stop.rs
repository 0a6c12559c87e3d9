//! The piston meets the ends of the cylinder.

use super::{ActsOn, Card, Family, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// The piston meets the ends of the cylinder.
pub struct EndStop;

static CARD: Card = Card {
    name: text("end_stop"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Base,
    summary: text("Stiff one-sided contact with damping outside the stroke."),
    equation: text(
        "outside |s| < L/2: force -k x (1 + c v) against the penetration x with speed of approach v, \
        never pulling",
    ),
    source: text(
        "[A] Eq. 1 (F_e), as a Hunt-Crossley contact; as printed F_e is outside the bracket, but it is a \
        force on the piston.",
    ),
    shows: text("Motion stops dead at +-L/2 while pressure rises."),
    experiment: text("Drive gently into both ends."),
    energy: text("Returns most of what it takes, dissipates the rest."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("end_stop_stiffness"),
        symbol: text("k"),
        unit: text("N/m"),
        meaning: text("contact stiffness"),
        kind: Kind::Linear,
        minimum: 0.0,
        maximum: 1e12,
        typical: 5e7,
        start: Start::at(&[5e7]),
        prior: None,
    },
    ParameterCard {
        name: text("end_stop_damping"),
        symbol: text("c"),
        unit: text("s/m"),
        meaning: text("damping factor of the contact"),
        kind: Kind::Shape,
        minimum: 0.0,
        maximum: 1e3,
        typical: 5.0,
        start: Start::at(&[5.0]),
        prior: None,
    },
];

impl Physics for EndStop {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let half_stroke = now.machine.cylinders[cylinder].stroke / 2.0;
        for side in [1.0, -1.0] {
            let penetration = (piston.displacement * side - half_stroke).positive_part();
            let approach = piston.velocity * side;
            let push = (penetration * parameters[0] * (parameters[1] * approach + 1.0)).positive_part();
            rows.piston_force[cylinder] -= push * side;
        }
    }
}
