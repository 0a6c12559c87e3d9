//! Mean powers of a cylinder by the sign of its opening.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::energy;

/// Mean powers of one cylinder while its valve is open towards the cap side, and towards the rod side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct ByOpening {
    /// While the opening is positive: the pump feeds the cap side.
    pub positive: MeanPowers,
    /// While the opening is negative: the pump feeds the rod side.
    pub negative: MeanPowers,
}

/// Mean powers of one cylinder with its joint; they are `null` where the duration is zero. The supply less what is stored and
/// dissipated is what the model does not explain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct MeanPowers {
    /// Time, s.
    pub duration: Option<f64>,
    /// Supplied through the valve, or by the measured force on the rod, W; negative: given back through the valve.
    pub supply: Option<f64>,
    /// Gain of the oil's compression energy, W.
    pub oil: Option<f64>,
    /// Gain of kinetic and potential energy, W.
    pub links: Option<f64>,
    /// Added by all effects other than its valve, W; negative: turned into heat.
    pub dissipation: Option<f64>,
}

impl ByOpening {
    /// Of one cylinder.
    pub fn of(both: &energy::ByOpening) -> Self {
        let powers = |totals| MeanPowers::of(totals, both.cylinder);
        ByOpening { positive: powers(&both.positive), negative: powers(&both.negative) }
    }
}

impl MeanPowers {
    fn of(totals: &energy::Totals, cylinder: usize) -> Self {
        let (own, duration) = (&totals.cylinders[cylinder], totals.duration);
        let mean = |energy: f64| finite(energy / duration);
        MeanPowers {
            duration: finite(duration),
            supply: mean(own.supplied),
            oil: mean(own.cap_internal + own.rod_internal),
            links: mean(own.kinetic + own.potential),
            dissipation: mean(totals.dissipation(cylinder)),
        }
    }
}
