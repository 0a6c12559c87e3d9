//! What a bag says of a topic.

use crate::Qos;

/// A topic to be added to a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TopicToWrite {
    /// Name: `/joint_states`.
    pub name: String,
    /// Type of the messages: `sensor_msgs/msg/JointState`.
    pub type_name: String,
    /// Definition of the type and of all types that it contains, `ros2msg`.
    pub schema: String,
    /// QoS that the publishers offer, one entry per publisher; may be empty.
    pub qos: Vec<Qos>,
}
