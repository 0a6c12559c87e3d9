//! The rows that effects add to: joint torque, piston force, chamber continuity, pump line, valve opening.

mod inputs;
mod layout;
mod rows;
mod situation;
pub mod smooth;
mod system;

pub use inputs::Inputs;
pub use layout::Layout;
pub use rows::Rows;
pub use situation::{Piston, Situation};
pub use system::{System, Workspace};
