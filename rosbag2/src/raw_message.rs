//! One message as bytes, of any type, and its topic.

use std::sync::Arc;

use bytes::Bytes;

use crate::Qos;

/// A topic as the bag defines it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Topic {
    /// Name: `/joint_states`.
    pub name: String,
    /// Type of the messages: `sensor_msgs/msg/JointState`; empty if the bag does not contain it.
    pub type_name: String,
    /// Language of the definition: `ros2msg` or `ros2idl`; empty when the bag has no definition.
    pub schema_encoding: String,
    /// Definition of the type and of all types that it contains.
    pub schema: String,
    /// Serialization of the messages: `cdr`.
    pub message_encoding: String,
    /// QoS that the publishers offered, in the YAML of the bag; see [`Topic::qos`].
    pub offered_qos_profiles: String,
}

impl Topic {
    /// QoS that the publishers offered; empty if the bag does not contain it.
    #[must_use]
    pub fn qos(&self) -> Vec<Qos> {
        Qos::list_from_yaml(&self.offered_qos_profiles)
    }
}

/// One message as bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawMessage {
    /// The topic; all messages of a topic within one file share it.
    pub topic: Arc<Topic>,
    /// Number assigned by the recorder or the publisher; often 0.
    pub sequence: u32,
    /// When the recorder received the message, ns since the epoch.
    pub log_time: u64,
    /// When the message was published, ns since the epoch; equal to `log_time` if the recorder does not know it.
    pub publish_time: u64,
    /// The message with its four bytes of encapsulation. A slice of the decompressed chunk of an MCAP file: cheap to
    /// clone, but it keeps the whole chunk in memory.
    pub data: Bytes,
}
