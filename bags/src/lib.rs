//! Bags to recordings and back.
//!
//! A bag is a rosbag2 folder (`metadata.yaml` beside MCAP or SQLite3 files, also compressed with zstd) or a bare `.mcap`
//! or `.db3` file. There are three levels:
//!
//! - [`read_recording`] and [`write_recording`]: `/arm/state` and `/arm/orifice_command` as a
//!   [`Recording`](excavator_model::recording::Recording), with a [`ReadReport`] of everything that was not perfect.
//! - [`RawMessages`] and [`BagWriter`]: the bytes of any topic, for recorders, players and repairs.
//! - [`info`]: what is in a bag, per topic.
//!
//! Damage is read around, never hidden: a file that was cut is read to the cut, a chunk with a wrong checksum is left
//! out, and each [`Damage`] says where, how many bytes, and up to which time the data is there.
//!
//! ```no_run
//! use excavator_bags::{Topics, read_recording};
//!
//! let (recording, report) = read_recording("drive_1".as_ref(), &Topics::default())?;
//! println!("{} samples in {} s", recording.len(), recording.duration());
//! for problem in report.problems() {
//!     eprintln!("{problem}");
//! }
//! # Ok::<(), excavator_bags::BagError>(())
//! ```

pub mod can;
pub mod cdr;
mod container;
pub mod dynamic;
mod error;
mod info;
mod limits;
mod location;
pub mod map;
mod metadata;
mod printable;
mod qos;
mod raw_messages;
mod reading;
mod regular_file;
mod reindex;
mod storage;
pub mod table;
mod topics;
mod writing;
pub mod yaml;

pub use container::{Damage, DamageKind};
pub use error::BagError;
pub use info::{
    BagInfo, ColumnInfo, EquationInfo, SignalInfo, SignalsInfo, SignalsTally, StampTiming, TableInfo, Timing,
    TopicInfo, info,
};
pub use limits::{Limit, LimitError, ReadLimits};
pub use printable::printable;
pub use qos::{Durability, History, Qos, Reliability};
pub use raw_messages::{RawMessage, RawMessages, Topic};
pub use reading::{Gap, ReadReport, StateTable, read_recording, read_recording_in_blocks};
pub use regular_file::{open_regular, read_regular, read_regular_text};
pub use reindex::{Reindexed, ReindexedFile, reindex};
pub use topics::Topics;
pub use writing::{
    BagWriter, Compression, GoneFile, TopicId, TopicToWrite, WriteOptions, check_replaceable, write_recording,
};
