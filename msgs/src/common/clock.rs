//! `rosgraph_msgs/Clock`.

use serde::{Deserialize, Serialize};

use crate::{Message, Time};

/// The time, where it is not that of the system.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Clock {
    /// Now.
    pub clock: Time,
}

impl Message for Clock {
    const TYPE_NAME: &'static str = "rosgraph_msgs/msg/Clock";
}
