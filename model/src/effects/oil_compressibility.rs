//! Compressibility of the oil and compliance of walls and hoses.

use super::{ActsOn, Card, Family, Growth, Kind, Needs, ParameterCard, Physics, Rows, Scalar, Site, Start, text};
use crate::equations::Situation;
use crate::machine::Machine;
use crate::machine::Supply;

/// Compressibility of the oil and compliance of walls and hoses.
pub struct OilCompressibility;

static CARD: Card = Card {
    name: text("oil_compressibility"),
    acts_on: ActsOn::CylinderOrPumpLine,
    needs: Needs::Oil,
    family: Family::Base,
    summary: text("Oil springs: pressure rises with the oil squeezed in."),
    equation: text("compliance V/b in V/b dp/dt = net flow; pump line Vp/bp"),
    source: text("[A] Eq. 1, 2"),
    shows: text("Pressure lags behind the net flow; ringing of pressure and load."),
    experiment: text("Steps of the valve."),
    energy: text("Stores V (b (exp(p/b) - 1) - p)."),
};

static PARAMETERS: &[ParameterCard] = &[ParameterCard {
    name: text("bulk_modulus"),
    symbol: text("b"),
    unit: text("Pa"),
    meaning: text("bulk modulus"),
    kind: Kind::Reciprocal,
    growth: Growth::NONE,
    minimum: 1e5,
    maximum: 1e11,
    typical: 1e9,
    start: Start::at(&[1e9]),
    prior: None,
}];

impl Physics for OilCompressibility {
    fn card(&self) -> &Card {
        &CARD
    }

    fn parameters(&self, _machine: &Machine, _site: Site) -> &[ParameterCard] {
        PARAMETERS
    }

    /// From hoses full of foam to water in a block of steel.
    fn plausible(&self, _machine: &Machine, _site: Site, _parameter: &str) -> Option<[f64; 2]> {
        Some([5e7, 4e9])
    }

    fn has_constant_compliance(&self) -> bool {
        true
    }

    fn contribute<T: Scalar>(&self, site: Site, parameters: &[T], now: &Situation<T>, rows: &mut Rows<T>) {
        match site {
            Site::Cylinder(cylinder) => {
                let piston = &now.pistons[cylinder];
                let oil = &piston.warmth.oil;
                rows.cap_compliance[cylinder] += oil.yielding(piston.cap_volume / parameters[0]);
                rows.rod_compliance[cylinder] += oil.yielding(piston.rod_volume / parameters[0]);
            }
            Site::PumpLine => {
                if let Supply::PumpLine(line) = now.machine.supply {
                    rows.pump_compliance += now.pump_oil.yielding(parameters[0].recip() * line.volume);
                }
            }
            Site::Machine => {}
        }
    }
}
