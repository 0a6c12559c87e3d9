//! From a recording, or from any messages, to a bag.

mod bag_writer;
mod options;
mod part;
mod write_recording;

pub use bag_writer::{BagWriter, TopicId, TopicToWrite};
pub use options::{Compression, WriteOptions};
pub use write_recording::write_recording;
