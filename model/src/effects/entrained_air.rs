//! Air bubbles in the oil.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Air bubbles in the oil.
pub struct EntrainedAir;

static CARD: Card = Card {
    name: text("entrained_air"),
    acts_on: ActsOn::Cylinder,
    needs: Needs::Oil,
    family: Family::Candidate,
    summary: text("Undissolved air makes the oil soft at low pressure."),
    equation: text(
        "compliance V (alpha/n) p0^(1/n) / (p0 + p)^(1 + 1/n) on top of V/b, p0 = 101325 Pa, n = 1.4: bubbles \
        compressed without losing heat",
    ),
    source: text("textbook (e.g. Merritt, Watton)"),
    shows: text("Pressure rises slowly from low values and stiffly from high ones."),
    experiment: text("Load changes of a chamber that starts near tank pressure."),
    energy: text("Stores the work of compressing the bubbles."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("air_fraction"),
    symbol: text("alpha"),
    unit: text("-"),
    meaning: text("volume of air per volume of oil at ambient pressure"),
    kind: Kind::Linear,
    growth: Growth::NONE,
    minimum: 0.0,
    maximum: 0.5,
    typical: 0.02,
    start: Start::at(&[5e-3]),
    prior: None,
}];

impl Physics for EntrainedAir {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let Site::Cylinder(cylinder) = site else { return };
        let piston = &now.pistons[cylinder];
        rows.cap_compliance[cylinder] += piston.cap_volume * bubble_compressibility(parameters[0], piston.cap_pressure);
        rows.rod_compliance[cylinder] += piston.rod_volume * bubble_compressibility(parameters[0], piston.rod_pressure);
    }
}

/// Ambient pressure p0, Pa absolute.
const AMBIENT: f64 = 101_325.0;

/// Lowest absolute pressure of the bubbles, Pa: real bubbles are limited by vapour pressure; this limit is for
/// searches.
const VACUUM: f64 = 1.0e3;

/// Polytropic index n of the bubbles: 1.4, because they are compressed too fast for heat exchange.
const POLYTROPIC_INDEX: f64 = 1.4;
const EXPONENT: f64 = 1.0 / POLYTROPIC_INDEX;
/// `ln(p0^(1/n))`.
const LN_AMBIENT_POWER: f64 = 11.526_088_451_496_5 / POLYTROPIC_INDEX;

/// Compressibility that the bubbles add, 1/Pa.
fn bubble_compressibility<T: Scalar>(fraction: T, pressure: T) -> T {
    let absolute = (pressure + (AMBIENT - VACUUM)).positive_part() + VACUUM;
    (-absolute.ln() * EXPONENT + LN_AMBIENT_POWER).exp() * fraction / (absolute * POLYTROPIC_INDEX)
}
