//! Reads a bag as a recording.

mod command_decoder;
mod command_track;
mod content;
mod late_stamps;
mod read_recording;
mod report;
mod same_shape;
mod state_decoder;
mod state_table;
mod topic_check;

pub(crate) use late_stamps::{count_late, steps_back};
pub(crate) use read_recording::{TopicCounts, truncated_after};
pub use read_recording::{read_recording, read_recording_in_blocks};
pub use report::{Gap, MappedUnit, ReadReport};
pub use state_table::StateTable;
pub(crate) use state_table::gaps;
