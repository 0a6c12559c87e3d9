//! Seals that rub more when they are cold.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::{Situation, USUAL_OIL_TEMPERATURE};
use crate::machine::{Machine, Size};

/// Seals that rub more when they are cold.
///
/// It acts on all friction of the piston that does not vanish with speed: Coulomb, Stribeck, pressure-dependent and asymmetric
/// friction. Without this effect, their level is that at 40 °C.
pub struct SealFrictionTemperature;

static CARD: Card = Card {
    name: text("seal_friction_temperature"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("Cold seals are hard and rub more."),
    equation: text("all friction of seals at the oil temperature T: Fc exp(-bs (T - 40)), T in degC"),
    source: text("textbook (Arrhenius law over a small range; e.g. Müller, Nau: Fluid Sealing Technology)"),
    shows: text("Force step at each reversal that falls while the machine warms up."),
    experiment: text("The same slow reversals with cold and with warm oil, with the oil temperature recorded."),
    energy: text("None of its own: it changes what friction dissipates."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("seal_friction_fall"),
    symbol: text("bs"),
    unit: text("1/K"),
    meaning: text("relative fall of seal friction per kelvin"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: -0.1,
    maximum: 0.2,
    typical: 0.02,
    start: Start::at(&[0.02]),
    prior: None,
}];

/// Least change that matters, 1/K: over 40 K it changes friction by an eighth.
const LEAST_CHANGE: f64 = 0.003;

impl Physics for SealFrictionTemperature {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn is_practically_significant(&self, _size: &Size, parameters: &[f64]) -> bool {
        parameters.first().is_some_and(|fall| fall.abs() >= LEAST_CHANGE)
    }

    fn has_power(&self) -> bool {
        false
    }

    fn reads_temperature(&self) -> bool {
        true
    }

    fn adjusts_others(&self) -> bool {
        true
    }

    fn adjust<T: Scalar>(&self, site: Site, parameters: &[T], now: &mut Situation<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let warmer = now.oil_temperature - USUAL_OIL_TEMPERATURE;
        now.pistons[cylinder].warmth.seal_friction = Some((-parameters[0] * warmer).exp());
    }
}
