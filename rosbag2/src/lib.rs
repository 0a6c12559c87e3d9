//! Reads, writes and repairs bags of rosbag2, and decodes their messages, without ROS.
//!
//! A bag is a rosbag2 folder (`metadata.yaml` next to MCAP or SQLite3 files, also compressed with zstd) or a bare `.mcap`
//! or `.db3` file.
//!
//! - [`RawMessages`] iterates over the bytes of all messages, [`BagWriter`] writes them.
//! - [`dynamic`] reads fields of messages of any type, by the definition in the bag; [`cdr`] decodes whole messages
//!   into your own types.
//! - [`info`](fn@info) reports the contents of a bag per topic, and the regularity of each topic.
//! - [`LossReader`] collects what a recorder tells of messages that it lost.
//! - [`reindex`](fn@reindex) makes a damaged bag readable for other readers.
//!
//! Damage is skipped and always reported: a truncated file is read up to the cut, a chunk with a wrong checksum is left
//! out, and each [`Damage`] contains the offset, the number of bytes lost, and the time up to which data is available.
//! Files are not trusted: [`ReadLimits`] bounds the cost of reading one.
//!
//! # Example
//!
//! ```
//! use rosbag2::{BagWriter, RawMessages, TopicToWrite, WriteOptions, cdr};
//!
//! let folder = tempfile::tempdir()?;
//! let bag = folder.path().join("drive_1");
//! let mut writer = BagWriter::create(&bag, &WriteOptions::default())?;
//! let topic = TopicToWrite {
//!     name: "/speed".into(),
//!     type_name: "std_msgs/msg/Float64".into(),
//!     schema: "float64 data".into(),
//!     qos: Vec::new(),
//! };
//! let speed = writer.add_topic(&topic)?;
//! writer.write(speed, 1_000_000_000, 1_000_000_000, &cdr::encode(&0.5)?)?;
//! writer.finish()?;
//!
//! let mut messages = RawMessages::open(&bag)?;
//! for topic in messages.topics() {
//!     println!("{}: {}", topic.name, topic.type_name);
//! }
//! for message in &mut messages {
//!     let message = message?;
//!     println!("{} at {} ns: {} bytes", message.topic.name, message.log_time, message.data.len());
//!     assert_eq!(cdr::decode::<f64>(&message.data)?, 0.5);
//! }
//! assert!(messages.damage().is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Features
//!
//! - `sqlite` (on by default): SQLite3 bags, with a bundled SQLite. Without it, such a bag is rejected.

pub mod cdr;
mod container;
pub mod dynamic;
mod error;
mod info;
mod limits;
mod location;
mod lost;
mod metadata;
pub mod prelude;
mod printable;
mod qos;
mod raw_message;
mod raw_messages;
mod regular_file;
mod reindex;
mod storage;
mod writing;
pub mod yaml;

pub use container::{Damage, DamageKind};
pub use error::{Error, in_short};
pub use info::{BagInfo, StampTiming, Timing, TopicInfo, info, info_with};
pub use limits::{Limit, LimitError, ReadLimits};
pub use lost::{LossReader, LostMessages};
pub use metadata::BagCompression;
pub use printable::{printable, printable_path};
pub use qos::{Durability, History, Qos, Reliability};
pub use raw_message::{RawMessage, Topic};
pub use raw_messages::RawMessages;
pub use regular_file::{open_regular, read_regular, read_regular_text};
pub use reindex::{Reindexed, ReindexedFile, reindex};
pub use writing::{BagWriter, Compression, GoneFile, Staging, TopicId, TopicToWrite, WriteOptions, check_replaceable};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
