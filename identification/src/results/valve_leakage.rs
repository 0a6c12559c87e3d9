//! Leakage of the closed valve.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Estimate, Outcome, finite};
use crate::characterisation;

/// Leakage of the closed valve, from pressure transients.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ValveLeakage {
    /// At the cap side.
    pub cap: Outcome<ChamberLeakage>,
    /// At the rod side.
    pub rod: Outcome<ChamberLeakage>,
    /// Bulk modulus that the coefficients rest on, Pa.
    pub bulk_modulus: Option<f64>,
    /// Number of times with closed valve.
    pub holds: usize,
}

/// Leakage past the lands at one chamber.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ChamberLeakage {
    /// From the pump into the chamber, m3/(s Pa).
    pub from_pump: Estimate,
    /// From the chamber to tank, m3/(s Pa).
    pub to_tank: Estimate,
    /// Time constant at mid-stroke with the piston held, s.
    pub time_constant: Estimate,
    /// Share of the pump pressure above tank that the chamber comes to, 0 to 1.
    pub static_gain: Estimate,
}

impl ValveLeakage {
    pub(super) fn of(leakage: &characterisation::ClosedValve) -> Self {
        ValveLeakage {
            cap: Outcome::of(&leakage.cap, ChamberLeakage::of),
            rod: Outcome::of(&leakage.rod, ChamberLeakage::of),
            bulk_modulus: finite(leakage.bulk_modulus),
            holds: leakage.holds.len(),
        }
    }
}

impl ChamberLeakage {
    fn of(side: &characterisation::ChamberLeakage) -> Self {
        ChamberLeakage {
            from_pump: Estimate::of(side.from_pump),
            to_tank: Estimate::of(side.to_tank),
            time_constant: Estimate::of(side.time_constant),
            static_gain: Estimate::of(side.static_gain),
        }
    }
}
