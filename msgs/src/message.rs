//! The trait of all message types of this crate.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A ROS 2 message type with a definition in [`crate::definitions`].
pub trait Message: Serialize + DeserializeOwned {
    /// Full name of the type in topics and bags, `package/msg/Type`.
    const TYPE_NAME: &'static str;
}
