//! Cushions at the ends of the stroke.

use super::end_stop::no_end;
use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Cushions at the ends of the stroke.
pub struct EndCushion;

static CARD: Card = Card {
    name: text("end_cushion"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("Near either end the oil left in the chamber leaves through a throttle that brakes the piston."),
    equation: text("within l of an end, moving towards it: force -c (depth/l) v; free on the way back (check valve)"),
    source: text("textbook (e.g. Merritt, Watton), linear in speed and depth"),
    shows: text(
        "The piston slows down before it meets the end, more the faster it comes; a force error in that region only.",
    ),
    experiment: text("Strokes into both ends at several speeds."),
    energy: text("Dissipates c (depth/l) v^2."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("cushion_length"),
        symbol: text("l"),
        unit: text("m"),
        meaning: text("length of the cushion before either end"),
        kind: Kind::Shape,
        growth: Growth::LENGTH,
        minimum: 1e-3,
        maximum: 0.5,
        typical: 0.03,
        start: Start::at(&[0.04, 0.08, 0.16]),
        prior: None,
    },
    ParameterCard {
        name: text("cushion_damping"),
        symbol: text("c"),
        unit: text("N s/m"),
        meaning: text("damping coefficient at the end of the stroke"),
        kind: Kind::Linear,
        growth: Growth::DAMPING,
        minimum: 0.0,
        maximum: 1e8,
        typical: 1e5,
        start: Start::at(&[2e4]),
        prior: None,
    },
];

impl Physics for EndCushion {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn why_not(&self, machine: &Machine, site: Site) -> Option<String> {
        no_end(machine, site)
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let [retracted, extended] = now.machine.cylinders[cylinder].ends;
        for (side, end) in [(1.0, extended), (-1.0, -retracted)] {
            let depth = (piston.displacement * side - end + parameters[0]).positive_part();
            if depth.value() <= 0.0 {
                continue;
            }
            let approach = (piston.velocity * side).positive_part();
            rows.piston_force[cylinder] -= parameters[1] * (depth / parameters[0]) * approach * side;
        }
    }
}
