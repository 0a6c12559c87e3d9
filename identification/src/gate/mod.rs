//! Is a recording fit for use with a model? Asked before any number is computed.

mod check;
mod clipped;
mod error;
mod opening;
mod runs;
mod stuck;
mod swapped;

pub use check::check;
pub use error::GateError;
