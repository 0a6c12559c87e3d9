//! Checks whether a recording can be used with a model, before any number is computed.

mod check;
mod clipped;
mod error;
mod impossible;
mod moves_closed;
mod opening;
mod remarks;
mod runs;
mod shared_readings;
mod stuck;
mod swapped;
mod swapped_forces;

pub use check::check;
pub use error::{CheckError, OVERRULABLE};
pub use impossible::remove_impossible;
pub use remarks::{Remark, remarks};
pub use shared_readings::{GivenTwice, SharedReadings, repeated, shared_readings};
