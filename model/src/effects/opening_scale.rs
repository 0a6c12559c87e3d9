//! A full opening that differs from the assumed one.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::{Machine, Size};

/// A full opening that differs from the assumed one.
///
/// If a command is known only in volts or per cent, its scale is a guess. The flow gains absorb the factor; what remains is the
/// opening at which the bypass is closed.
pub struct OpeningScale;

static CARD: Card = Card {
    name: text("opening_scale"),
    acts_on: ActsOn::Valve,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text(
        "The bypass closes sooner or later than recorded openings say: the full scale of the command or of the spool sensor is not what was assumed.",
    ),
    equation: text(
        "section of the bypass umax - (1 + k) |u| in place of umax - |u|; flow gains are those of the opening as recorded",
    ),
    source: text("ours: commands in volts or per cent"),
    shows: text("Pump pressure at large openings is too low or too high, however the flow gains are fitted."),
    experiment: text("Trapezoids up to the full opening."),
    energy: text("Changes what the bypass loses; dissipates nothing itself."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("opening_scale"),
    symbol: text("k"),
    unit: text("-"),
    meaning: text("relative error of the full scale: recorded openings times 1 + k are the true ones"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: -0.9,
    maximum: 4.0,
    typical: 0.1,
    start: Start::at(&[0.0, -0.2]),
    prior: None,
}];

/// Relative full-scale error of good spool sensors. A linkage worn by 1.6 mm looks like a scale error of 0.7 %.
const ACCURACY: f64 = 0.01;

impl Physics for OpeningScale {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn has_power(&self) -> bool {
        false
    }

    fn is_practically_significant(&self, _size: &Size, parameters: &[f64]) -> bool {
        parameters.first().is_some_and(|scale| scale.abs() >= ACCURACY)
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &mut now.pistons[cylinder];
        piston.bypass_closing *= parameters[0] + 1.0;
    }
}
