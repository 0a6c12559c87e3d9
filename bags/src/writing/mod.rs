//! From a recording, or from any messages, to a bag.

mod bag_writer;
mod counted;
mod gone;
mod options;
mod part;
mod reserve;
mod staging;
mod write_recording;

pub use bag_writer::{BagWriter, TopicId, TopicToWrite};
pub use gone::GoneFile;
pub use options::{Compression, WriteOptions};
pub use staging::check_replaceable;
pub use write_recording::write_recording;
