//! Is a recording fit for use with a model? Asked before any number is computed.

mod check;

pub use check::{GateError, check};
