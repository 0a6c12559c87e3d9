//! `excavator_msgs/EnergyState`.

use serde::{Deserialize, Serialize};

use crate::{CylinderEnergy, Header, Message};

/// Energy balance of the arm, one entry per cylinder, plus the pump line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EnergyState {
    /// Time of the state that the balance was computed from.
    pub header: Header,
    /// One balance per cylinder.
    pub cylinders: Vec<CylinderEnergy>,
    /// `b (exp(p/b) - 1) Q`, W: pump flow Q with its pressure p and the energy of its compressed oil, b the bulk modulus of the pump line.
    pub pump_power: f64,
    /// Power throttled to tank through the open centre, W.
    pub bypass_loss: f64,
    /// Power throttled in the valve sections between pump, cylinders and tank, W.
    pub metering_loss: f64,
}

impl Message for EnergyState {
    const TYPE_NAME: &'static str = "excavator_msgs/msg/EnergyState";
}
