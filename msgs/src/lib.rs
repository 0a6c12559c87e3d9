//! The ROS 2 interface package `excavator_msgs` in Rust.
//!
//! This folder is two things at once: a ROS 2 package (`package.xml`, `CMakeLists.txt`, `msg/`) that any workspace can
//! build, and this crate, whose structs have the same fields in the same order, so that serde writes and reads them as
//! CDR. A test compares every struct with its `.msg` file: name, order and type of each field, nested ones included.
//!
//! A `NaN` in any field means "not measured". All quantities are SI except temperatures, which are in °C.

mod arm_state;
pub mod common;
mod cylinder_energy;
mod cylinder_state;
pub mod definitions;
mod energy_state;
mod energy_term;
mod field;
mod header;
pub mod layout;
mod message;
mod orifice_command;
mod time;
mod type_description;

pub use arm_state::ArmState;
pub use cylinder_energy::CylinderEnergy;
pub use cylinder_state::CylinderState;
pub use energy_state::EnergyState;
pub use energy_term::EnergyTerm;
pub use header::Header;
pub use message::Message;
pub use orifice_command::OrificeCommand;
pub use time::Time;
pub use type_description::{FieldDescription, FieldType, IndividualTypeDescription, TypeDescription};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
