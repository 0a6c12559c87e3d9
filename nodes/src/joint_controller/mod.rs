//! Joint commands as openings of valves: the other side of `topic_based_ros2_control`, so that MoveIt and controllers of ROS 2 drive the
//! simulator.
//!
//! ros2_control's hardware interfaces are C++. Its `topic_based_ros2_control` has one that writes `sensor_msgs/JointState` with what
//! controllers want on one topic and reads how the joints are on another. This node takes the first and publishes the second.

mod law;
mod node;

pub(crate) use node::parameters;
pub use node::run;
