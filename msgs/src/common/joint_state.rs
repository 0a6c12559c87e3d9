//! `sensor_msgs/JointState`.

use serde::{Deserialize, Serialize};

use crate::{Header, Message};

/// State of joints; each list is as long as `name`, or empty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointState {
    /// Time of the sample.
    pub header: Header,
    /// Names of the joints.
    pub name: Vec<String>,
    /// Angles, rad; displacements, m, for prismatic joints.
    pub position: Vec<f64>,
    /// Rates, rad/s or m/s.
    pub velocity: Vec<f64>,
    /// Torques, N m, or forces, N.
    pub effort: Vec<f64>,
}

impl Message for JointState {
    const TYPE_NAME: &'static str = "sensor_msgs/msg/JointState";
}
