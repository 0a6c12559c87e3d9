//! An accumulator on the pump line.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;

/// Gas behind a bladder or piston, on the pump line.
pub struct Accumulator;

static CARD: Card = Card {
    name: text("accumulator"),
    acts_on: ActsOn::PumpLine,
    needs: Needs::Oil,
    family: Family::Construction,
    summary: text("Gas on the pump line takes up oil and gives it back."),
    equation: text(
        "compliance of the pump line (V0/n) p0^(1/n) / p^(1 + 1/n), times 1/(1 + (p0/p)^8), which is none below the pre-charge p0; absolute pressures, n = 1.4",
    ),
    source: text("textbook (polytropic gas; e.g. Merritt, Murrenhoff)"),
    shows: text(
        "Pump pressure falls slowly while oil is drawn and recovers as slowly; below the pre-charge it collapses.",
    ),
    experiment: text("Draw oil until the pressure is below the pre-charge, then let the pump fill it."),
    energy: text("Stores the work of compressing the gas."),
};

static PARAMETERS: &[ParameterCard] = &[
    ParameterCard {
        name: text("accumulator_volume"),
        symbol: text("V0"),
        unit: text("m3"),
        meaning: text("volume of the gas at the pre-charge"),
        kind: Kind::Linear,
        growth: Growth::VOLUME,
        minimum: 0.0,
        maximum: 10.0,
        typical: 1e-3,
        start: Start::at(&[1e-3]),
        prior: None,
    },
    ParameterCard {
        name: text("precharge_pressure"),
        symbol: text("p0"),
        unit: text("Pa"),
        meaning: text("gauge pressure of the gas without oil"),
        kind: Kind::Shape,
        growth: Growth::NONE,
        minimum: 1e5,
        maximum: 1e8,
        typical: 5e6,
        start: Start::at(&[5e6]),
        prior: None,
    },
];

impl Physics for Accumulator {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    fn contribute<T: Scalar>(&self, _site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        let (precharge, pressure) = (parameters[1] + AMBIENT, (now.pump_pressure + AMBIENT).positive_part() + VACUUM);
        let height = pressure.ln() - precharge.ln();
        let left_its_shell = ((height * -ONSET).exp() + 1.0).recip();
        let volume = parameters[0] * (-height / POLYTROPIC_INDEX).exp();
        rows.accumulator_compliance += left_its_shell * volume / (pressure * POLYTROPIC_INDEX);
    }
}

/// Ambient pressure, Pa absolute.
const AMBIENT: f64 = 101_325.0;

/// Polytropic index n of nitrogen that is compressed too fast for heat exchange.
const POLYTROPIC_INDEX: f64 = 1.4;

/// Sharpness of the onset of the gas compliance at the pre-charge: half of it there, 96 % at one and a half times the pre-charge.
/// A real bladder has no sharper corner, and the stored energy is an integral over it.
const ONSET: f64 = 8.0;

/// Lowest absolute pressure of the oil, Pa: real oil is limited by its vapour pressure; this limit is for searches.
const VACUUM: f64 = 1.0e3;
