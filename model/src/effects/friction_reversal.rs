//! Speed over which friction changes sign.

use super::prior::for_people;
use super::{
    ActsOn, Card, Corner, Family, Finding, Growth, Kind, Needs, ParameterCard, Physics, Prior, PriorScale, Scalar,
    Site, Spread, Start, text,
};
use crate::equations::Situation;
use crate::equations::smooth::SLIP_SPEED;
use crate::machine::Machine;

/// Speed over which friction changes sign at a reversal of the piston.
///
/// Real friction does not jump: seals stretch, asperities bend, and a simulation with a jump would stall. The equations round the
/// jump over 1 mm/s, which is a choice and not a property of a machine. If a machine (or another simulator) rounds it
/// differently, every reversal leaves an error that looks like weak Stribeck friction, and Coulomb friction is off by several
/// percent.
pub struct FrictionReversal;

static CARD: Card = Card {
    name: text("friction_reversal"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Rounding,
    summary: text("The piston's friction reverses over a speed range other than the nominal 1 mm/s."),
    equation: text(
        "sgn(v) = tanh(v/vr) in all friction of the piston, or along another curve of v/vr with friction_corner",
    ),
    source: text("convention (the papers print sgn(v)); width of presliding, textbook"),
    shows: text("A short error of the motion at every reversal, of the same shape each time."),
    experiment: text("Slow reversals, and holds with the valve nearly closed."),
    energy: text("None of its own: it rounds what other effects dissipate."),
};

/// A transition over 0.2 mm/s to 6 mm/s counts as rounding: each end is about one and a half standard deviations of a factor of 3
/// away from 1 mm/s. A recording cannot resolve sharper ones. The slowest seals reach 6 mm/s; above that, the friction has a
/// shape of its own.
const PRIOR: Prior = Prior { spread: Spread::Fixed(3.0), scale: PriorScale::Logarithmic, range: [-1.46, 1.63] };

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("reversal_speed"),
    symbol: text("vr"),
    unit: text("m/s"),
    meaning: text("speed over which the sign of the velocity changes"),
    kind: Kind::Shape,
    growth: Growth::SEAL_SPEED,
    minimum: 1e-4,
    maximum: 2e-2,
    typical: 3e-3,
    start: Start::at(&[SLIP_SPEED]),
    prior: Some(PRIOR),
}];

impl Physics for FrictionReversal {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn finding(&self, parameters: &[(f64, &str)]) -> Option<Finding> {
        let &[(speed, unit)] = parameters else { return None };
        let sentences = [
            "The regularisation velocity of friction differs from its default",
            "The regularisation velocities of friction differ from their default",
        ];
        Some(Finding { sentences, value: for_people(speed, unit) })
    }

    fn has_power(&self) -> bool {
        false
    }

    fn rounds(&self) -> Option<Corner> {
        Some(Corner::Friction)
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        now.pistons[cylinder].rounding.reversal_speed = parameters[0];
    }
}
