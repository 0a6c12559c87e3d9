//! What changed in a machine: between two sets of recordings, or from the begin to the end of recordings.

mod changes;
mod drift;

pub(crate) use changes::between;
pub use changes::{Changes, ParameterChange, changes};
pub use drift::drift;
