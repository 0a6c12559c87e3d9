//! The ROS 2 layer: arguments, parameters, connection, clock, diagnostics, log.
//!
//! A process has one [`Link`]: one participant, one node, one tokio worker. A node declares its parameters, opens its
//! endpoints on the link and runs its own loop on a plain thread; the main thread of the process supervises the link
//! ([`Supervisor`]) and waits for SIGINT or SIGTERM. Endpoints outlive the connection below them: if the middleware has
//! permanently lost a peer or one of its threads has died, the link is rebuilt with every endpoint.
//!
//! ```no_run
//! use excavator_msgs::common::Text;
//! use excavator_ros::{RosArguments, Supervisor, TopicQos};
//!
//! // excavator node --ros-args -r __ns:=/left
//! let (ros, _) = RosArguments::parse(&std::env::args().collect::<Vec<_>>())?;
//! let supervisor = Supervisor::start("parrot", &ros, Vec::new())?;
//! let outlet = supervisor.link.publish("said", TopicQos::reliable(10))?;
//! supervisor.link.subscribe("heard", TopicQos::reliable(10), move |text: Text, _| {
//!     // A reader that is behind misses a word; `outlet.refused()` counts it.
//!     let _ = outlet.publish(text);
//! })?;
//! supervisor.run(|| {});
//! supervisor.leave();
//! # Ok::<(), excavator_ros::RosError>(())
//! ```
//!
//! Every node takes `--ros-args` with `-r from:=to`, `-r __node:=`, `-r __ns:=`, `-p name:=value`, `--params-file`, `--log-level`,
//! `--log-file-name`, `--enclave`, and reads `ROS_DOMAIN_ID`, `ROS_AUTOMATIC_DISCOVERY_RANGE`, `ROS_LOCALHOST_ONLY`, `ROS_LOG_DIR`,
//! `ROS_SECURITY_*` and `RMW_IMPLEMENTATION` (which decides how services are mapped: `rmw_cyclonedds_cpp` or all others).
//!
//! # Faults of the middleware
//!
//! RustDDS 0.15.1 has faults that show with other DDS implementations. Each workaround has its own file, which says when it can be removed:
//!
//! | fault | remedy |
//! |---|---|
//! | a peer whose lease ran out is never matched again | `health.rs`: a scout looks for it, the link is rebuilt |
//! | threads end when a system call is interrupted | `threads.rs`: they are counted, the link is rebuilt |
//! | a call can deadlock | `patience.rs`: what may hang runs on a thread of its own |
//! | each fragment of a sample with inline QoS has one byte too many | `large_replies.rs`: long replies go another way |
//! | Fast DDS does not see that a participant has left | `farewell.rs`: the message is sent once more in the form of Fast DDS |
//! | announcements carry no timestamp; Fast DDS may drop those out of order | `probe.rs`: two probes prove it, the link is rebuilt |
//! | Fast DDS ignores the first request for missing samples | `reminder.rs`: the request is sent once more |
//! | malformed packets end threads or exhaust memory | `guard`: a filter in the kernel, in front of the sockets |

mod arguments;
mod arrivals;
mod clock;
pub mod connection;
pub mod dds_names;
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
pub mod prelude;
mod probe;
mod qos;
pub mod raw;
mod raw_bytes;
mod readers;
mod reminder;
mod rtps;
mod security;
mod services;
mod signals;
mod supervisor;
mod threads;
mod type_descriptions;
mod value_text;

pub use arguments::ros_words;
pub use arguments::{Level, RosArguments};
pub use clock::RosClock;
pub use clock::system_nanoseconds;
pub use diagnostics::{Diagnostics, Health};
pub use environment::{DiscoveryRange, Environment, Mapping};
pub use error::RosError;
pub use inlet::Received;
pub use large_replies::LargeReplies;
pub use latched::Latched;
pub use lifecycle::Lifecycle;
pub use link::Link;
pub use logger::Logger;
pub use names::{NodeIdentity, Remap};
pub use outlet::{Outlet, PublishError};
pub use pace::Pace;
pub use parameter::{Kind, Parameter, Range, Value};
pub use parameters::Parameters;
pub use peers::Peers;
pub use qos::TopicQos;
pub use security::Security;
pub use services::{service_mapping, service_qos};
pub use signals::{Signals, end_with_this_process};
pub use supervisor::Supervisor;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
