//! Converts joint commands to valve openings. It is the counterpart of `topic_based_ros2_control`, so that MoveIt and ROS 2
//! controllers can drive the simulator.
//!
//! The hardware interfaces of ros2_control are C++. The interface in `topic_based_ros2_control` writes the commands of
//! controllers as `sensor_msgs/JointState` to one topic, and reads the joint states from another. This node subscribes to the
//! first and publishes the second.

mod law;
mod node;

pub use law::JointLaw;
pub use node::{parameters, run};
