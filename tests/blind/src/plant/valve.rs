//! Effects in the valve section, and the way from spool to opening.

use super::geometry::MAXIMUM_OPENING;

/// How the opening follows the command where no spool sensor exists.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    /// Time constant of the first stage, s.
    pub first: f64,
    /// Time constant of a second stage, s; 0 = there is none.
    pub second: f64,
    /// Pure delay before both, s.
    pub delay: f64,
}

/// Effects in the valve section.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Valve {
    /// Overlap dz+ for u > 0, m².
    pub dead_zone_positive: f64,
    /// Overlap dz- for u < 0, m².
    pub dead_zone_negative: f64,
    /// Relative change of the cap side flow gain for u < 0.
    pub directional_cap: f64,
    /// Relative change of the rod side flow gain for u < 0.
    pub directional_rod: f64,
    /// Area law, coefficient of x - 1/2 with x = |u|/umax.
    pub bend: f64,
    /// Area law, coefficient of x² - 1/3.
    pub curl: f64,
    /// Play between spool and opening, full width, m².
    pub hysteresis: f64,
    /// Laminar leakage pump-cap, cap-tank, pump-rod, rod-tank, m³/(s Pa).
    pub leakage: [f64; 4],
    /// Lag from command to opening; `Some` also means that there is no spool sensor.
    pub lag: Option<Lag>,
    /// Share of the flow from chamber back to pump that a check valve stops.
    pub load_check: f64,
    /// Pressure loss per square of the flow in each hose between valve and chamber, Pa s²/m⁶.
    pub hose_resistance: f64,
}

impl Valve {
    /// Position after play: follows `wanted` only when pushed, `before` is where it stood.
    pub fn play(&self, before: f64, wanted: f64) -> f64 {
        if self.hysteresis == 0.0 {
            return wanted;
        }
        let half = self.hysteresis / 2.0;
        before.clamp(wanted - half, wanted + half)
    }

    /// Flow over the root of the pressure drop, m³/(s sqrt(Pa)), of an edge of this gain and the hose behind it.
    pub fn behind_hose(&self, gain: f64) -> f64 {
        gain / (1.0 + self.hose_resistance * gain * gain).sqrt()
    }

    /// Opening of the metering edges for a spool position, both m².
    pub fn opening(&self, spool: f64) -> f64 {
        let past_edge = if spool > 0.0 {
            (spool - self.dead_zone_positive).max(0.0)
        } else {
            (spool + self.dead_zone_negative).min(0.0)
        };
        let share = past_edge.abs() / MAXIMUM_OPENING;
        past_edge * (1.0 + self.bend * (share - 0.5) + self.curl * (share * share - 1.0 / 3.0))
    }

    /// Flow from pump to chamber after the check valve.
    pub fn checked(&self, flow: f64) -> f64 {
        if flow < 0.0 { flow * (1.0 - self.load_check) } else { flow }
    }
}
