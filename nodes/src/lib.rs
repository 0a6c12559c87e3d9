//! Live nodes for instrumented hydraulic machines: each a function that runs until a stop is requested.
//!
//! A node takes its ROS arguments and plain options. It knows no command line and no terminal: what it has to say goes to its log, to
//! its diagnostics, or back to the caller.
//!
//! | module | node |
//! |---|---|
//! | [`arm_simulator`] | a model as a machine, in a process of its own behind the command gate |
//! | [`arm_bridge`] | datagrams, CAN frames and topics of other makers as states |
//! | [`joint_controller`] | joint commands of ros2_control as openings of valves |
//! | [`energy_monitor`] | the energy balance of the machine, state by state |
//! | [`identification_node`] | the action that identifies a model from bags |
//! | [`recorder`], [`player`] | topics into a bag, and back |
//! | `dashboard` | the live topics as a page, with the feature of that name |
//!
//! Between them stand [`arm_state`], which converts states of the machine, and `command_gate`, through which every command to a valve
//! passes.

pub mod arm_bridge;
pub mod arm_simulator;
pub mod arm_state;
mod command_gate;
#[cfg(feature = "dashboard")]
pub mod dashboard;
pub mod energy_monitor;
mod error;
pub mod identification_node;
pub mod joint_controller;
mod models;
pub mod player;
pub mod recorder;

pub use error::NodeError;

#[cfg(feature = "can")]
#[doc(hidden)]
pub use arm_bridge::can::fuzzing;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
