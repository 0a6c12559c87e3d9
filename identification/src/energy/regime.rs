//! Regimes: conditions of a cylinder under which the ledger is judged.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A condition under which the ledger is judged on its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Condition")]
pub enum Regime {
    /// The whole recording.
    Always,
    /// The rod moves out.
    Extending,
    /// The rod moves in.
    Retracting,
    /// The valve is nearly closed: less than a twentieth of its largest opening.
    ValveClosed,
    /// The valve opens.
    OpeningStroke,
    /// The valve closes.
    ClosingStroke,
}

impl Regime {
    /// All of them; the first is always met.
    pub const ALL: [Regime; 6] = [
        Regime::Always,
        Regime::Extending,
        Regime::Retracting,
        Regime::ValveClosed,
        Regime::OpeningStroke,
        Regime::ClosingStroke,
    ];

    /// Text that follows a comma.
    pub fn words(self) -> &'static str {
        match self {
            Regime::Always => "over the whole recording",
            Regime::Extending => "while extending",
            Regime::Retracting => "while retracting",
            Regime::ValveClosed => "with the valve closed",
            Regime::OpeningStroke => "on opening strokes",
            Regime::ClosingStroke => "on closing strokes",
        }
    }

    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Regime::Always => "always",
            Regime::Extending => "extending",
            Regime::Retracting => "retracting",
            Regime::ValveClosed => "valve_closed",
            Regime::OpeningStroke => "opening_stroke",
            Regime::ClosingStroke => "closing_stroke",
        }
    }
}

/// Means over one window that determine its regimes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Situation {
    /// Piston velocity, m/s.
    pub velocity: f64,
    /// Magnitude of the opening as a share of the largest one.
    pub opening: f64,
    /// Its rate, 1/s.
    pub opening_rate: f64,
}

/// Speed below which a piston counts as resting, m/s.
const RESTING: f64 = 5e-3;
/// Share of the largest opening below which a valve counts as closed.
const CLOSED: f64 = 0.05;
/// Rate of the opening above which the valve is in a stroke, 1/s.
const STROKE: f64 = 0.2;

impl Situation {
    /// Whether a window belongs to a regime.
    pub fn is(&self, regime: Regime) -> bool {
        match regime {
            Regime::Always => true,
            Regime::Extending => self.velocity > RESTING,
            Regime::Retracting => self.velocity < -RESTING,
            Regime::ValveClosed => self.opening < CLOSED,
            Regime::OpeningStroke => self.opening_rate > STROKE,
            Regime::ClosingStroke => self.opening_rate < -STROKE,
        }
    }
}
