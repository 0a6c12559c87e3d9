//! From a bag to a recording.

mod command_track;
mod read_recording;
mod report;
mod state_decoder;
mod state_table;
mod topic_check;

pub(crate) use read_recording::{TopicCounts, truncated_after};
pub use read_recording::{read_recording, read_recording_in_blocks};
pub use report::{Gap, ReadReport};
pub use state_table::StateTable;
pub(crate) use state_table::{count_late, gaps};
