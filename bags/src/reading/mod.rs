//! From a bag to a recording.

mod command_track;
mod read_recording;
mod report;
mod state_decoder;
mod state_table;
mod topic_check;

pub use read_recording::read_recording;
pub use report::{Gap, ReadReport};
