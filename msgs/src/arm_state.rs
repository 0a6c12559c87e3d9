//! `excavator_msgs/ArmState`.

use serde::{Deserialize, Serialize};

use crate::{CylinderState, Header, Message};

/// State of the instrumented arm at `header.stamp`, simulated or bridged; `NaN` = not measured.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ArmState {
    /// Time of the sample.
    pub header: Header,
    /// One entry per hydraulic cylinder.
    pub cylinders: Vec<CylinderState>,
    /// Pump pressure pp, Pa (gauge).
    pub pump_pressure: f64,
    /// Tank pressure pt, Pa (gauge).
    pub tank_pressure: f64,
    /// Pump flow Qp, m³/s.
    pub pump_flow: f64,
    /// Oil temperature T, °C.
    pub oil_temperature: f64,
}

impl Message for ArmState {
    const TYPE_NAME: &'static str = "excavator_msgs/msg/ArmState";
}
