//! A model from reference to position of a drive under its own position controller, where no pressures are measured.

mod position_fit;
mod position_loop;

pub use position_fit::{PositionRecording, PositionerError, PositionerFit, fit_positioner};
pub use position_loop::PositionLoop;
