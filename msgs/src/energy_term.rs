//! `excavator_msgs/EnergyTerm`.

use serde::{Deserialize, Serialize};

use crate::Message;

/// Power of one physical effect in the energy balance of one cylinder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EnergyTerm {
    /// Name in the effect catalogue: "viscous_damping", "internal_leakage", ...
    pub effect: String,
    /// Power of the effect, W, negative = taken out of the stored energy.
    pub power: f64,
}

impl Message for EnergyTerm {
    const TYPE_NAME: &'static str = "excavator_msgs/msg/EnergyTerm";
}
