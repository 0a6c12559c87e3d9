//! What every message type of this crate can say about itself.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A ROS 2 message type with a definition in [`crate::definitions`].
pub trait Message: Serialize + DeserializeOwned {
    /// Full name of the type as topics and bags carry it, `package/msg/Type`.
    const TYPE_NAME: &'static str;
}
