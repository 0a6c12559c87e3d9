//! `excavator_msgs/OrificeCommand`.

use serde::{Deserialize, Serialize};

use crate::{Header, Message};

/// Commanded orifice areas. A cylinder that is not named keeps its last command.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OrificeCommand {
    /// Time from which the command holds.
    pub header: Header,
    /// Names of the commanded cylinders; as many as `areas`.
    pub names: Vec<String>,
    /// Commanded orifice areas r, m², + = pump to cap side; as many as `names`.
    pub areas: Vec<f64>,
}

impl Message for OrificeCommand {
    const TYPE_NAME: &'static str = "excavator_msgs/msg/OrificeCommand";
}
