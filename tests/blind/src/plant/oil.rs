//! Effects in the chambers' oil.

/// Ambient pressure, Pa absolute.
const AMBIENT: f64 = 101_325.0;
/// Gain of the make-up valves, m³/(s Pa): 3e-4 m³/s, most of the pump's flow, at 1 bar.
const MAKE_UP_GAIN: f64 = 3e-9;

/// Effects in the oil.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Oil {
    /// Volume of free air per volume of oil at ambient pressure.
    pub air_fraction: f64,
    /// Polytropic index of the bubbles; between 1 (slow) and 1.4 (fast).
    pub polytropic_index: f64,
    /// Gauge pressure below which make-up flow enters a chamber, Pa; `None` = only the vapour limit.
    pub make_up_pressure: Option<f64>,
}

impl Oil {
    /// Compressibility that the bubbles add, 1/Pa: `(alpha/n) p0^(1/n) / p^(1 + 1/n)` with p absolute.
    pub fn bubble_compressibility(&self, pressure: f64) -> f64 {
        if self.air_fraction == 0.0 {
            return 0.0;
        }
        let absolute = (pressure + AMBIENT).max(1e3);
        self.air_fraction * (AMBIENT / absolute).powf(1.0 / self.polytropic_index) / (self.polytropic_index * absolute)
    }

    /// Make-up flow into a chamber, m³/s.
    pub fn make_up(&self, pressure: f64) -> f64 {
        self.make_up_pressure.map_or(0.0, |opens| MAKE_UP_GAIN * (opens - pressure).max(0.0))
    }
}
