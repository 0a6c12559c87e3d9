//! Where the oil comes from.

/// The hydraulic supply of the valve sections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Supply {
    /// A pump feeding a line whose pressure is a state of the model, \[A\] Eq. 2.
    PumpLine(PumpLine),
    /// The supply pressure is set from outside and measured: closed-centre systems, \[B\].
    MeasuredPressure,
    /// No oil at all: the force on the load is measured.
    None,
}

/// Known constants of the pump and its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PumpLine {
    /// Volume Vp of the line, m³.
    pub volume: f64,
    /// Pump flow Qp where the recording does not measure it, m³/s.
    pub flow: f64,
    /// Tank pressure pt where the recording does not measure it, Pa (gauge).
    pub tank_pressure: f64,
}
