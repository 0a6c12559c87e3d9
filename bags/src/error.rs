//! Errors when reading or writing a recording or a table.

use std::path::PathBuf;

use excavator_model::recording::RecordingError;
use rosbag2::{in_short, printable, printable_path as shown};
use thiserror::Error;

use crate::map::MapError;

/// A recording or a table that cannot be read or written at all. Damage that can be skipped is not an error but a
/// [`Damage`](rosbag2::Damage) in the report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BagError {
    /// The bag or file itself cannot be read or written.
    #[error(transparent)]
    Bag(#[from] rosbag2::Error),
    /// The bag has no such topic.
    #[error("{} has no topic {}; it has {}", shown(path), printable(topic), listed(existing))]
    NoTopic {
        /// The bag.
        path: PathBuf,
        /// The requested topic.
        topic: String,
        /// The topics that exist.
        existing: Vec<String>,
    },
    /// The bag contains several machines, each in a namespace.
    #[error(
        "{}: there is a machine in each of the namespaces {}; say which with --namespace",
        shown(path),
        namespaces.iter().map(|namespace| printable(namespace)).collect::<Vec<_>>().join(", ")
    )]
    SeveralMachines {
        /// The bag.
        path: PathBuf,
        /// The namespaces.
        namespaces: Vec<String>,
    },
    /// The topic exists, but no message of it could be read.
    #[error("{}: topic {} has no readable message{}", shown(path), printable(topic), because(damage))]
    NoMessages {
        /// The bag.
        path: PathBuf,
        /// The requested topic.
        topic: String,
        /// The damage that may be the reason, one line each; empty for an intact bag.
        damage: Vec<String>,
    },
    /// The topic carries another type of message.
    #[error("{}: topic {} has type {}, expected {expected}", shown(path), printable(topic), printable(found))]
    WrongType {
        /// The bag.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Type in the bag.
        found: String,
        /// The type that can be read.
        expected: &'static str,
    },
    /// The bag was written with another version of the message definition.
    #[error(
        "{}: the definition of {type_name} that topic {} was recorded with differs from ours: {}",
        shown(path),
        printable(topic),
        printable(difference)
    )]
    OtherDefinition {
        /// The bag.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Type of the messages.
        type_name: &'static str,
        /// The first field that differs.
        difference: String,
    },
    /// No message of the topic can be decoded; the fields describe the first.
    #[error(
        "{}: message {index} on topic {} ({bytes} bytes) cannot be decoded: {}",
        shown(path),
        printable(topic),
        printable(reason)
    )]
    Undecodable {
        /// The bag.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// Number of the message on its topic, from 0.
        index: u64,
        /// Length of the message in bytes.
        bytes: usize,
        /// What is wrong with the bytes.
        reason: String,
    },
    /// An error in a topic map, or a mismatch between the map and the data.
    #[error("{}", printable(&_0.to_string()))]
    Map(#[from] MapError),
    /// A table that cannot be read.
    #[error("{}: {}", shown(path), printable(reason))]
    BadTable {
        /// The file.
        path: PathBuf,
        /// The fault, and how to fix it.
        reason: String,
    },
    /// The recording violates its invariants.
    #[error("the recording cannot be written: {0}")]
    InvalidRecording(#[from] RecordingError),
    /// The stamp of a sample cannot be a ROS time.
    #[error("sample {index} cannot be written: its stamp of {nanoseconds} ns is outside 1970 to 2038")]
    StampOutOfRange {
        /// Index of the sample.
        index: usize,
        /// The stamp, ns since the epoch.
        nanoseconds: i64,
    },
    /// Two samples less than a nanosecond apart.
    #[error("samples {} and {index} cannot be written: both have the stamp {nanoseconds} ns", index - 1)]
    StampsCoincide {
        /// Index of the second sample.
        index: usize,
        /// The stamp, ns since the epoch.
        nanoseconds: i64,
    },
    /// A message that cannot be encoded.
    #[error("a message for topic {} cannot be encoded: {}", printable(topic), printable(reason))]
    Unencodable {
        /// The topic.
        topic: String,
        /// The error of the encoder.
        reason: String,
    },
}

fn listed(topics: &[String]) -> String {
    if topics.is_empty() { "no topics at all".to_string() } else { printable(&topics.join(", ")).into_owned() }
}

fn because(damage: &[String]) -> String {
    if damage.is_empty() { String::new() } else { format!(" ({})", printable(&in_short(damage))) }
}
