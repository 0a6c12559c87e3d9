//! Effects in the instruments.

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
    /// Delay of the displacement sensor, s.
    pub displacement_delay: f64,
    /// Delay of the three pressure sensors, s.
    pub pressure_delay: f64,
}
