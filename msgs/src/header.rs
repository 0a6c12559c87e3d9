//! `std_msgs/Header`.

use serde::{Deserialize, Serialize};

use crate::{Message, Time};

/// When, and in which coordinate frame, the values of a message hold.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Header {
    /// Time of the sample, not of its publication.
    pub stamp: Time,
    /// Name of the coordinate frame; empty when the values have none.
    pub frame_id: String,
}

impl Message for Header {
    const TYPE_NAME: &'static str = "std_msgs/msg/Header";
}
