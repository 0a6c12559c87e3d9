//! Effects in the instruments.

use std::f64::consts::TAU;

/// What instruments add to what they measure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensors {
    /// Offset of the cap side pressure sensor, Pa.
    pub cap_offset: f64,
    /// Offset of the rod side pressure sensor, Pa.
    pub rod_offset: f64,
    /// Offset of the pump pressure sensor, Pa.
    pub pump_offset: f64,
    /// Offset of the displacement sensor, m.
    pub displacement_offset: f64,
    /// Amplitude of the error of a displacement that is measured over a worn linkage, m.
    pub linkage_error: f64,
    /// Stroke over which this error comes again, m.
    pub linkage_period: f64,
    /// Delay of the displacement sensor, s.
    pub displacement_delay: f64,
    /// Delay of the three pressure sensors, s.
    pub pressure_delay: f64,
}

impl Sensors {
    /// What the displacement sensor makes of a displacement, m, before its delay.
    pub fn displacement(&self, truth: f64) -> f64 {
        let worn = if self.linkage_error == 0.0 {
            0.0
        } else {
            self.linkage_error * (TAU * truth / self.linkage_period).sin()
        };
        truth + self.displacement_offset + worn
    }
}
