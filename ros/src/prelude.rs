//! Imports that most nodes need: `use excavator_ros::prelude::*;`.
//!
//! Message types are in the crate `excavator_msgs`.

pub use crate::{
    Diagnostics, Health, Latched, Lifecycle, Link, Logger, Outlet, Pace, Parameter, Parameters, PublishError, Received,
    RosArguments, RosClock, RosError, Supervisor, TopicQos, Value,
};
