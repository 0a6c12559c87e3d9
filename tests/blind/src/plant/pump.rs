//! Effects at the pump line.

/// Effects at the pump line.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pump {
    /// Cracking pressure of a relief valve, Pa; looked at only when the gain is not 0.
    pub relief_pressure: f64,
    /// Gain of the relief valve, m³/(s Pa).
    pub relief_gain: f64,
    /// Pump flow lost per pressure, m³/(s Pa).
    pub leakage: f64,
    /// Spool travel before the bypass begins to close, m².
    pub bypass_overlap: f64,
}

impl Pump {
    /// Flow through the relief valve, m³/s.
    pub fn relief(&self, pressure: f64) -> f64 {
        self.relief_gain * (pressure - self.relief_pressure).max(0.0)
    }
}
