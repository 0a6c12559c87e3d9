//! Sharpness of the friction corner.

use super::{
    ActsOn, Card, Corner, Family, Finding, Growth, Kind, Needs, ParameterCard, Physics, Prior, PriorScale, Scalar,
    Site, Spread, Start, text,
};
use crate::equations::Situation;
use crate::machine::Machine;

/// Sharpness of the friction curve where the velocity changes sign.
///
/// Besides the speed of the transition ([`super::friction_reversal`]), the friction curve has a shape. Seals that stretch and
/// then slip all at once give a sharp corner; seals that slip one after the other approach their level late. The hyperbolic
/// tangent of the equations is a choice. With a straight corner, pressure-dependent friction has a loss of 0.4 even with the
/// right effect.
pub struct FrictionCorner;

static CARD: Card = Card {
    name: text("friction_corner"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Rounding,
    summary: text("The piston's friction reverses along a curve other than the nominal hyperbolic tangent."),
    equation: text(
        "sgn(v) = tanh(sinh(sqrt(q) x)/sqrt(q)), x = v/vr; q < 0: tanh(asinh(sqrt(-q) x)/sqrt(-q)), in all friction of the piston",
    ),
    source: text("convention (the papers print sgn(v)); shapes of presliding, textbook"),
    shows: text("A short error of the motion before and after every reversal, of the same shape each time."),
    experiment: text("Slow reversals, and holds with the valve nearly closed."),
    energy: text("None of its own: it rounds what other effects dissipate."),
};

/// Shapes reach from softer than `x / sqrt(1 + x^2)`, at minus one, to nearly straight, at four: one standard deviation. Below
/// minus two, friction would grow at working speeds. Above about twelve, three deviations, no recording can resolve the shape.
const PRIOR: Prior = Prior { spread: Spread::Fixed(4.0), scale: PriorScale::Linear, range: [-0.5, 5.0] };

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("corner_sharpness"),
    symbol: text("q"),
    unit: text("-"),
    meaning: text("-1 as x/sqrt(1 + x^2), 0 as tanh(x), 4 nearly straight up to one"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: -4.0,
    maximum: 20.0,
    typical: 1.0,
    start: Start::at(&[0.0]),
    prior: Some(PRIOR),
}];

impl Physics for FrictionCorner {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn finding(&self, parameters: &[(f64, &str)]) -> Option<Finding> {
        let (sharpness, _) = *parameters.first()?;
        let sentences = [
            "The sign function of friction has another sharpness than the default",
            "The sign functions of friction have another sharpness than the default",
        ];
        Some(Finding { sentences, value: (if sharpness > 0.0 { "sharper" } else { "softer" }).to_string() })
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
        now.pistons[cylinder].rounding.corner_sharpness = Some(parameters[0]);
    }
}
