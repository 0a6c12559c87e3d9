//! Power that the energy ledger misses.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::energy::{self, Regime};

/// Power that goes missing, or appears without a source, at one equation, beyond what noise explains.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
#[must_use]
pub struct MissingPower {
    /// Cylinder; `null` for the pump line, and where several joints share an equation.
    pub cylinder: Option<String>,
    /// Name of the equation: `arm.cap_continuity`.
    pub equation: String,
    /// The condition under which it is clearest.
    pub condition: Regime,
    /// Mean power, W; negative: it goes missing, positive: it appears.
    pub mean_power: Option<f64>,
    /// Root mean square of the power, W.
    pub size: Option<f64>,
    /// Largest power by size in one window, W; negative: it goes missing.
    pub peak_power: Option<f64>,
    /// Size that noise, the parameters' errors and the tolerance explain, W.
    pub band: Option<f64>,
    /// All of it in one sentence.
    pub sentence: String,
}

/// What the energy ledger misses in one recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct RecordingLedger {
    /// The recording.
    pub source: String,
    /// Power that is missing, most significant first; empty where the ledger closes.
    pub found: Vec<MissingPower>,
}

impl MissingPower {
    /// Of power that is missing.
    pub fn of(missing: &energy::MissingPower) -> Self {
        MissingPower {
            cylinder: missing.cylinder.clone(),
            equation: missing.equation.clone(),
            condition: missing.regime,
            mean_power: finite(missing.mean),
            size: finite(missing.size),
            peak_power: finite(missing.peak),
            band: finite(missing.band),
            sentence: missing.sentence.clone(),
        }
    }
}
