//! The oil supply.

/// The hydraulic supply of the valve sections.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Supply {
    /// A pump feeding a line whose pressure is a state of the model, \[A\] Eq. 2.
    PumpLine(PumpLine),
    /// The supply pressure is given from outside, at any flow: closed-centre systems, \[B\].
    PressureSource(PressureSource),
    /// No oil: the force on the load is measured.
    None,
}

impl Supply {
    /// Tank pressure if the recording does not measure it, Pa (gauge); zero without oil.
    pub fn tank_pressure(&self) -> f64 {
        match self {
            Supply::PumpLine(line) => line.tank_pressure,
            Supply::PressureSource(source) => source.tank_pressure,
            Supply::None => 0.0,
        }
    }

    /// Pump flow if the recording does not measure it, m³/s; zero if the supply pressure is given from outside.
    pub fn pump_flow(&self) -> f64 {
        match self {
            Supply::PumpLine(line) => line.flow,
            Supply::PressureSource(_) | Supply::None => 0.0,
        }
    }
}

/// Known constants of a supply with externally controlled pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PressureSource {
    /// Supply pressure Pp if the recording does not measure it, Pa (gauge).
    pub pressure: f64,
    /// Tank pressure Pt if the recording does not measure it, Pa (gauge).
    pub tank_pressure: f64,
}

/// Known constants of the pump and its line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PumpLine {
    /// Volume Vp of the line, m³.
    pub volume: f64,
    /// Pump flow Qp if the recording does not measure it, m³/s.
    pub flow: f64,
    /// Tank pressure pt if the recording does not measure it, Pa (gauge).
    pub tank_pressure: f64,
}
