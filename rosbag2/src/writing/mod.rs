//! Writes messages to a bag.

mod bag_writer;
mod counted;
mod gone;
mod options;
mod part;
mod reserve;
mod staging;
mod topic_to_write;

pub use bag_writer::{BagWriter, TopicId};
pub use gone::GoneFile;
pub use options::{Compression, WriteOptions};
pub use staging::{Staging, check_replaceable};
pub use topic_to_write::TopicToWrite;
