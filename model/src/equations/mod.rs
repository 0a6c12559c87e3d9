//! The rows that effects add to: joint torque, piston force, chamber continuity, pump line, valve opening.

mod channel;
mod inputs;
mod instruments;
mod law_states;
mod layout;
mod own_rows;
pub mod planar_chain;
mod rounding;
mod rows;
mod situation;
pub mod smooth;
mod system;
mod valves;
mod warmth;

pub use channel::Channel;
pub use inputs::{ImposedState, Inputs, USUAL_OIL_TEMPERATURE};
pub use instruments::{Distortion, Instruments};
pub use law_states::LawStates;
pub use layout::Layout;
pub use own_rows::{OwnRows, Reach};
pub use rounding::{EndStopCorrection, Rounding};
pub use rows::Rows;
pub use situation::{Piston, Situation};
pub use system::{KnownCylinder, System, Workspace};
pub use warmth::{Oil, Warmth};
