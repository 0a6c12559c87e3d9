//! The stretches of a long recording that tell most.
//!
//! An hour says hardly more about a machine than the best two minutes of it, and costs thirty times as much. Each stretch has an
//! information matrix about the model's parameters; those stretches are kept whose matrices together have the largest determinant, which
//! makes the volume of the parameters' confidence region smallest (D-optimal design, Fedorov 1972). They are chosen while the recording
//! goes by, so that no more than these are in memory.

mod joined;
mod stretches;

pub use joined::joined;
pub use stretches::{Chosen, Selection, SelectionSettings};
