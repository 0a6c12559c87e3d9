//! Writes messages to a bag.

mod bag_writer;
mod counted;
mod gone;
mod options;
mod part;
mod reserve;
mod staging;

pub use bag_writer::{BagWriter, TopicId, TopicToWrite};
pub use gone::GoneFile;
pub use options::{Compression, WriteOptions};
pub use staging::{Staging, check_replaceable};
