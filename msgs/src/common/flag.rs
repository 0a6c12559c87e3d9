//! `std_msgs/Bool`.

use serde::{Deserialize, Serialize};

use crate::Message;

/// Yes or no.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Flag {
    /// Yes or no.
    pub data: bool,
}

impl Message for Flag {
    const TYPE_NAME: &'static str = "std_msgs/msg/Bool";
}
