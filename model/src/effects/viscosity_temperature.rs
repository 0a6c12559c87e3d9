//! Oil that is thicker when it is cold.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Scalar, Site, Start, text};
use crate::equations::{Situation, USUAL_OIL_TEMPERATURE};
use crate::machine::{Machine, Size};

/// Oil that is thicker when it is cold.
///
/// Viscous damping of the cylinder grows with the viscosity, and its laminar leakages fall with it. Without this effect, the viscosity
/// is that at 40 °C. Orifices are turbulent and do not change; leakage of the pump does not change either.
///
/// The law is Vogel's with the constant of mineral oils, 95 K. One parameter describes a common oil from 0 to 100 °C: of an ISO VG 46
/// with a viscosity index of 100, the law gives 630 mm²/s at 0 °C and 6.8 mm²/s at 100 °C (data sheets: about 600, 6.8).
pub struct ViscosityTemperature;

static CARD: Card = Card {
    name: text("viscosity_temperature"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Nothing,
    family: Family::Candidate,
    summary: text("Cold oil is thicker: more viscous damping, less leakage."),
    equation: text(
        "Fd and all laminar leakages at the oil temperature T: Fd m, Ci / m, Ce / m, with m = exp(-bv (T - 40) 135 / (T + 95)), T in degC",
    ),
    source: text("Vogel 1921, with 95 K for mineral oils; data sheets of ISO VG oils"),
    shows: text("Damping that falls and leakage that grows while the machine warms up."),
    experiment: text("The same strokes and holds with cold and with warm oil, with the oil temperature recorded."),
    energy: text("None of its own: it changes what damping and leakage dissipate."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("viscosity_fall"),
    symbol: text("bv"),
    unit: text("1/K"),
    meaning: text("relative fall of the viscosity per kelvin at 40 degC"),
    kind: Kind::Shape,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 0.15,
    typical: 0.045,
    start: Start::at(&[0.045]),
    prior: None,
}];

/// Least fall that matters, 1/K: over 40 K it changes damping and leakage by a fifth.
const LEAST_FALL: f64 = 0.005;

/// Vogel's constant for mineral oils, K.
const VOGEL: f64 = 95.0;

/// Coldest oil that the law is evaluated for, °C: colder oil does not flow.
const POUR_POINT: f64 = -60.0;

/// Viscosity relative to that at 40 °C, for oil of `temperature` °C whose viscosity falls there by `fall` per kelvin.
fn relative_viscosity<T: Scalar>(fall: T, temperature: T) -> T {
    let temperature = (temperature - POUR_POINT).positive_part() + POUR_POINT;
    let warmer = (temperature - USUAL_OIL_TEMPERATURE) * (USUAL_OIL_TEMPERATURE + VOGEL) / (temperature + VOGEL);
    (-fall * warmer).exp()
}

impl Physics for ViscosityTemperature {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    /// From synthetic oils with a high viscosity index to naphthenic ones.
    fn plausible(&self, _machine: &Machine, _site: Site, _parameter: &str) -> Option<[f64; 2]> {
        Some([0.01, 0.08])
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
        let Site::Cylinder(cylinder) = site else { return };
        let viscosity = relative_viscosity(parameters[0], now.oil_temperature);
        now.pistons[cylinder].warmth.oil.viscosity = Some(viscosity);
    }
}
