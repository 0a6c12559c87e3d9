//! `sensor_msgs/FluidPressure`, and the array of them that excavators with OPERA's interface send.

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

/// Several pressure sensors, each named by its frame.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FluidPressureArray {
    /// The sensors.
    pub array: Vec<FluidPressure>,
}

impl Message for FluidPressureArray {
    const TYPE_NAME: &'static str = "com3_msgs/msg/FluidPressureArray";
}
