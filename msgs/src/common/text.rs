//! `std_msgs/String`.

use serde::{Deserialize, Serialize};

use crate::Message;

/// A text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Text {
    /// The text.
    pub data: String,
}

impl Message for Text {
    const TYPE_NAME: &'static str = "std_msgs/msg/String";
}
