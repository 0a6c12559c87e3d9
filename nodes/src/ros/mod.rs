//! Everything that has to do with ROS 2, in one place: arguments, parameters, connection, clock, diagnostics, log.
//!
//! A process has one [`Link`]: one participant, one node, one tokio worker. A node declares its parameters, opens its
//! endpoints on the link and runs its own loop on a plain thread; the main thread of the process supervises the link
//! ([`Supervisor`]) and waits for SIGINT or SIGTERM. Endpoints outlive the connection underneath them: when the
//! middleware has lost a peer for good or one of its threads has died, the link is built anew and every endpoint with it.
//!
//! # Names
//!
//! All but those of `/diagnostics`, `/rosout`, `/parameter_events` and `/clock` are relative to the node's namespace.
//!
//! | command | node | topics |
//! |---|---|---|
//! | `excavator node arm-simulator` | `/arm_simulator` | publishes `arm/state`, `joint_states`, `arm/model`, `robot_description`; takes `arm/orifice_command`, `arm/stop` |
//! | `excavator node energy-monitor` | `/energy_monitor` | takes `arm/state`, `arm/model`; publishes `arm/energy` |
//! | `excavator node arm-bridge` | `/arm_bridge` | publishes `arm/state`, `joint_states` |
//! | `excavator node identification` | `/identification` | action `/identification/run`; publishes `arm/model` on demand |
//! | `excavator record` | `/bag_recorder` | takes what it is told to |
//! | `excavator play` | `/bag_player` | publishes what the bag has, commands and `/clock` on demand |
//!
//! Every node takes `--ros-args` with `-r from:=to`, `-r __node:=`, `-r __ns:=`, `-p name:=value`, `--params-file`,
//! `--log-level`, `--enclave`, and reads `ROS_DOMAIN_ID`, `ROS_AUTOMATIC_DISCOVERY_RANGE`, `ROS_LOCALHOST_ONLY` and
//! `ROS_SECURITY_*` and `RMW_IMPLEMENTATION` (which decides how services are mapped: `rmw_cyclonedds_cpp` or all others).

mod arguments;
mod clock;
pub(crate) mod connection;
pub(crate) mod dds_names;
mod diagnostics;
mod environment;
mod error;
mod farewell;
mod guard;
mod health;
mod inlet;
mod large_replies;
mod latched;
mod lifecycle;
mod link;
mod log_file;
mod logger;
mod memory;
mod middleware_log;
mod names;
mod networks;
mod outlet;
mod pace;
mod parameter;
mod parameter_file;
mod parameter_services;
mod parameters;
mod patience;
mod peers;
mod qos;
pub(crate) mod raw;
mod reminder;
mod rtps;
mod security;
mod services;
mod signals;
mod supervisor;
mod threads;
mod value_text;

pub(crate) use arguments::ros_words;
pub use arguments::{Level, RosArguments};
pub use clock::RosClock;
pub(crate) use clock::system_nanoseconds;
pub use diagnostics::{Diagnostics, Health};
pub use environment::{DiscoveryRange, Environment, Mapping};
pub use error::RosError;
pub use inlet::Received;
pub(crate) use large_replies::LargeReplies;
pub use latched::Latched;
pub use lifecycle::Lifecycle;
pub use link::Link;
pub use logger::Logger;
pub use names::{NodeIdentity, Remap};
pub use outlet::{Outlet, PublishError};
pub use pace::Pace;
pub use parameter::{Kind, Parameter, Range, Value};
pub use parameters::Parameters;
pub(crate) use peers::Peers;
pub use qos::TopicQos;
pub use security::Security;
pub(crate) use services::{service_mapping, service_qos};
pub use signals::{Signals, end_with_this_process};
pub use supervisor::Supervisor;
