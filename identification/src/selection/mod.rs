//! Selects the most informative stretches of a long recording.
//!
//! An hour contains hardly more information about a machine than the best two minutes of it, and costs thirty times as
//! much. Each stretch has an information matrix about the model's parameters. The kept stretches are those whose joint
//! information matrix has the largest determinant, which minimises the volume of the parameters' confidence region
//! (D-optimal design, Fedorov 1972). They are chosen while the recording is read, so that only these are in memory.

mod joined;
mod stretches;

pub use joined::joined;
pub use stretches::{Chosen, Selection, SelectionSettings};
