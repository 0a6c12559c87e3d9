//! Converts bags and tables to recordings and back.
//!
//! - [`read_recording`] and [`write_recording`]: `/arm/state` and `/arm/orifice_command` as a
//!   [`Recording`](excavator_model::recording::Recording), with a [`ReadReport`] of all imperfections.
//! - [`map`]: topics and columns of other formats as the signals of a recording; [`table`]: columns of numbers from
//!   files; [`can`]: signals in CAN frames.
//! - [`SignalsInfo`]: the available signals, and what they can identify.
//!
//! The crate [`rosbag2`] handles the bags themselves, their raw messages, damage and repair.
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
mod error;
mod info;
pub mod map;
mod own_messages;
pub mod prelude;
mod reading;
pub mod table;
mod topics;
mod write_recording;

pub use error::BagError;
pub use info::{ColumnInfo, EquationInfo, SignalInfo, SignalsInfo, SignalsTally, TableInfo};
pub use own_messages::{own_definitions, topic_to_write, write_message};
pub use reading::{Gap, MappedUnit, ReadReport, StateTable, read_recording, read_recording_in_blocks};
pub use topics::Topics;
pub use write_recording::write_recording;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
