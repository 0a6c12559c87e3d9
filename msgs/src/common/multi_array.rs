//! `std_msgs/Float64MultiArray`.

use serde::{Deserialize, Serialize};

use crate::Message;

/// Numbers, and what its sender says of their order.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Float64MultiArray {
    /// Dimensions. Some senders name each number by the label of a dimension.
    pub layout: MultiArrayLayout,
    /// The numbers.
    pub data: Vec<f64>,
}

/// Order of the numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MultiArrayLayout {
    /// Outermost dimension first.
    pub dim: Vec<MultiArrayDimension>,
    /// Numbers before the first one of the array.
    pub data_offset: u32,
}

/// One dimension.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MultiArrayDimension {
    /// Its name.
    pub label: String,
    /// Number of elements.
    pub size: u32,
    /// Numbers from one element of the dimension outside it to the next.
    pub stride: u32,
}

impl Message for Float64MultiArray {
    const TYPE_NAME: &'static str = "std_msgs/msg/Float64MultiArray";
}
