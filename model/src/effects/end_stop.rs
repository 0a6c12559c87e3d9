//! Stops at the ends of the stroke.

use super::{
    ActsOn, Card, Corner, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text,
};
use crate::equations::Situation;
use crate::machine::{Cylinder, Machine};

/// Contact of the piston with the ends of the cylinder.
pub struct EndStop;

static CARD: Card = Card {
    name: text("end_stop"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Base,
    summary: text("Stiff one-sided contact with damping outside the stroke."),
    equation: text(
        "outside the ends of the stroke (+-L/2, or the file's own): force -k x (1 + c v) against the penetration x with speed of approach v, \
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
        growth: Growth::STIFFNESS,
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
        growth: Growth::PER_SPEED,
        minimum: 0.0,
        maximum: 1e3,
        typical: 5.0,
        start: Start::at(&[5.0]),
        prior: None,
    },
];

/// Why an effect at the ends of the stroke cannot act at `site`: a motor has no ends.
pub(super) fn no_end(machine: &Machine, site: Site) -> Option<String> {
    match site {
        Site::Cylinder(index) if machine.cylinders.get(index).is_some_and(Cylinder::is_motor) => {
            Some("a motor has no end of stroke".to_string())
        }
        _ => None,
    }
}

/// Depth over which the viscous damping of the contact increases, m, on a machine of the reference size: a jump would stall a
/// simulation.
const ONSET: f64 = 2e-5;

impl Physics for EndStop {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn why_not(&self, machine: &Machine, site: Site) -> Option<String> {
        no_end(machine, site)
    }

    fn corner(&self, _parameters: &[f64]) -> Option<Corner> {
        Some(Corner::EndStop)
    }

    fn confines(&self) -> bool {
        true
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let [retracted, extended] = now.machine.cylinders[cylinder].ends;
        let (mut stiffness, mut damping) = (parameters[0], parameters[1]);
        let mut ends = [T::from(extended), T::from(-retracted)];
        let mut viscous = None;
        if let Some(real) = &piston.rounding.end_stop {
            stiffness *= real.stiffness;
            damping *= real.damping;
            viscous = Some(real.viscous_damping);
            ends = [real.shifts[0] + extended, real.shifts[1] - retracted];
        }
        for (side, end) in [1.0, -1.0].into_iter().zip(ends) {
            let penetration = (piston.displacement * side - end).positive_part();
            let approach = piston.velocity * side;
            let mut push = penetration * stiffness * (damping * approach + 1.0);
            if let Some(viscous) = viscous {
                let touched = ONSET * now.machine.size_at(site).factor(Growth::LENGTH);
                push += viscous * approach * penetration / (penetration + touched);
            }
            let push = push.positive_part();
            rows.piston_force[cylinder] -= push * side;
        }
    }
}
