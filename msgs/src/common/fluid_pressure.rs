//! `sensor_msgs/FluidPressure`.

use serde::{Deserialize, Serialize};

use crate::{Header, Message};

/// One pressure sensor.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FluidPressure {
    /// Time of the sample; the frame names the sensor.
    pub header: Header,
    /// Absolute pressure, Pa.
    pub fluid_pressure: f64,
    /// Variance, Pa²; 0 is unknown.
    pub variance: f64,
}

impl Message for FluidPressure {
    const TYPE_NAME: &'static str = "sensor_msgs/msg/FluidPressure";
}
