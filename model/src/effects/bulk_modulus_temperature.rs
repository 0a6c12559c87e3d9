//! Oil that is softer when it is warm.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::{Situation, USUAL_OIL_TEMPERATURE};
use crate::machine::{Machine, Size};

/// Oil that is softer when it is warm.
///
/// Without this effect, the bulk modulus is that at 40 °C. Entrained air has a law of its own and does not change.
pub struct BulkModulusTemperature;

static CARD: Card = Card {
    name: text("bulk_modulus_temperature"),
    acts_on: ActsOn::CylinderOrPumpLine,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text("Warm oil is softer."),
    equation: text("bulk modulus at the oil temperature T: b exp(-bb (T - 40)), T in degC"),
    source: text("textbook (e.g. Merritt; Hayward 1965: about 0.5 %/K for mineral oil)"),
    shows: text("Ringing after valve steps that slows down while the machine warms up."),
    experiment: text("The same steps of the valve with cold and with warm oil, with the oil temperature recorded."),
    energy: text("None of its own: it changes what the oil stores."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("bulk_modulus_fall"),
    symbol: text("bb"),
    unit: text("1/K"),
    meaning: text("relative fall of the bulk modulus per kelvin"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 0.05,
    typical: 0.005,
    start: Start::at(&[0.005]),
    prior: None,
}];

/// Least fall that matters, 1/K: over 40 K it changes the bulk modulus by a twentieth, as a volume may be wrong.
const LEAST_FALL: f64 = 0.0012;

impl Physics for BulkModulusTemperature {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    /// Mineral oil has 0.004 to 0.006; hoses soften too.
    fn plausible(&self, _machine: &Machine, _site: Site, _parameter: &str) -> Option<[f64; 2]> {
        Some([0.0, 0.02])
    }

    fn is_practically_significant(&self, _size: &Size, parameters: &[f64]) -> bool {
        parameters.first().is_some_and(|fall| fall.abs() >= LEAST_FALL)
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
        let compressibility = (parameters[0] * (now.oil_temperature - USUAL_OIL_TEMPERATURE)).exp();
        match site {
            Site::Cylinder(cylinder) => now.pistons[cylinder].warmth.oil.compressibility = Some(compressibility),
            Site::PumpLine => now.pump_oil.compressibility = Some(compressibility),
            Site::Machine => {}
        }
    }
}
