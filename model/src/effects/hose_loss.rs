//! Pressure loss in hoses and pipes.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Pressure loss in hoses and pipes.
pub struct HoseLoss;

static CARD: Card = Card {
    name: text("hose_loss"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("Force against the motion that grows with the square of speed."),
    equation: text("force -zeta v |v|"),
    source: text("[B] Eq. 17-18; printed as v^2, which would push along for v < 0"),
    shows: text("Force error bends upward with speed, opposite for the two directions."),
    experiment: text("Steady strokes at several speeds up to the fastest."),
    energy: text("Dissipates zeta |v|^3."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("hose_loss"),
    symbol: text("zeta"),
    unit: text("N s2/m2"),
    meaning: text("loss coefficient"),
    kind: Kind::Linear,
    growth: Growth::DRAG,
    minimum: 0.0,
    maximum: 1e9,
    typical: 3e5,
    start: Start::at(&[1e5]),
    prior: None,
}];

impl Physics for HoseLoss {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        rows.piston_force[cylinder] -= parameters[0] * piston.velocity * piston.velocity.abs();
    }
}
