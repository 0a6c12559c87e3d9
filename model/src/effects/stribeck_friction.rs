//! Stribeck friction.

use super::{
    ActsOn, Card, Corner, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text,
};
use crate::equations::Situation;
use crate::machine::{Machine, Size};

/// Stribeck friction.
pub struct StribeckFriction;

static CARD: Card = Card {
    name: text("stribeck_friction"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("Extra friction near standstill that fades as the seal floats up on its oil film."),
    equation: text("force -Fs exp(-(v/vs)^2) sgn(v), the sign rounded (friction_reversal)"),
    source: text("textbook (e.g. Armstrong-Helouvry, Dupont, Canudas de Wit 1994)"),
    shows: text("Friction force against speed: the upturn near zero."),
    experiment: text("Very slow strokes with reversals."),
    energy: text("Dissipates Fs exp(-(v/vs)^2) |v|."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("stribeck_force"),
        symbol: text("Fs"),
        unit: text("N"),
        meaning: text("friction at standstill above the Coulomb level"),
        kind: Kind::Linear,
        growth: Growth::FORCE,
        minimum: 0.0,
        maximum: 1e6,
        typical: 500.0,
        start: Start::at(&[300.0]),
        prior: None,
    },
    ParameterCard {
        name: text("stribeck_speed"),
        symbol: text("vs"),
        unit: text("m/s"),
        meaning: text("speed at which it has fallen to 37 %"),
        kind: Kind::Shape,
        growth: Growth::SEAL_SPEED,
        minimum: 1e-3,
        maximum: 0.2,
        typical: 0.015,
        start: Start::at(&[6e-3, 2.5e-2]),
        prior: None,
    },
];

/// Lowest significant Stribeck speed in m/s. Below it the curve cannot be separated from the rounding of friction at reversals,
/// for which the model assumes 1 mm/s: a fault-free machine with another rounding gave an estimate of 1.0 mm/s. Seals have 5 to
/// 20 mm/s.
const SLOWEST: f64 = 3e-3;

impl Physics for StribeckFriction {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn is_practically_significant(&self, size: &Size, parameters: &[f64]) -> bool {
        parameters.get(1).is_some_and(|speed| *speed >= SLOWEST * size.factor(Growth::SEAL_SPEED))
    }

    fn corner(&self, parameters: &[f64]) -> Option<Corner> {
        // A friction of zero has no corner.
        parameters.first().is_some_and(|level| *level > 0.0).then_some(Corner::Friction)
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        let relative = piston.velocity / parameters[1];
        let level = piston.rubbing(parameters[0]) * (-(relative * relative)).exp();
        rows.piston_force[cylinder] -= level * piston.direction();
    }
}
