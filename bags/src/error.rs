//! Why a bag cannot be read or written.

use std::path::{Path, PathBuf};

use excavator_model::recording::RecordingError;
use thiserror::Error;

use crate::dynamic::LayoutError;
use crate::limits::LimitError;
use crate::map::MapError;
use crate::printable;

/// A bag that cannot be read or written at all. Damage that can be read around is no error but a
/// [`Damage`](crate::Damage) in the report.
#[derive(Debug, Error)]
pub enum BagError {
    /// Nothing at that path.
    #[error("{} does not exist", shown(path))]
    DoesNotExist {
        /// The path asked for.
        path: PathBuf,
    },
    /// The operating system refused to read or write.
    #[error("cannot {action} {}: {source}", shown(path))]
    Io {
        /// What was tried: "read", "create", ...
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A FIFO, a device, a socket, or a folder in the place of a file.
    #[error("{} is not a regular file but {}; give a file", shown(path), printable(found))]
    NotARegularFile {
        /// The path asked for.
        path: PathBuf,
        /// What is there: "a FIFO", "a device", ...
        found: &'static str,
    },
    /// A file that costs more than [`ReadLimits`](crate::ReadLimits) allow.
    #[error("{}: {source}", shown(path))]
    Limit {
        /// The file.
        path: PathBuf,
        /// The bound, with the numbers found and allowed.
        source: LimitError,
    },
    /// A folder without any file of a bag, or a file that is none.
    #[error("{} is not a bag: {}; give a rosbag2 folder, an .mcap or a .db3 file", shown(path), printable(reason))]
    NotABag {
        /// The path asked for.
        path: PathBuf,
        /// What was found instead.
        reason: String,
    },
    /// `metadata.yaml` is not what rosbag2 writes.
    #[error("{}: {}; move the file away to read the bag without it", shown(path), printable(reason))]
    BadMetadata {
        /// Path of `metadata.yaml`.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// `metadata.yaml` lists a file that is not there.
    #[error(
        "{} lists {}, which is not there; put it back, or move metadata.yaml away to read the other files",
        shown(metadata),
        printable(file)
    )]
    MissingFile {
        /// Path of `metadata.yaml`.
        metadata: PathBuf,
        /// The listed file.
        file: String,
    },
    /// A storage other than MCAP and SQLite3.
    #[error(
        "{}: {} storage is not supported; convert the bag to MCAP with `ros2 bag convert`",
        shown(path),
        printable(storage)
    )]
    UnsupportedStorage {
        /// The bag.
        path: PathBuf,
        /// Name of the storage as the metadata has it.
        storage: String,
    },
    /// Files or messages compressed by rosbag2 itself with something else than zstd.
    #[error(
        "{}: rosbag2 compression mode \"{}\" ({}) is not supported; convert the bag with `ros2 bag convert`",
        shown(path),
        printable(mode),
        printable(format)
    )]
    UnsupportedCompression {
        /// The bag.
        path: PathBuf,
        /// `compression_mode` of the metadata: "file" or "message".
        mode: String,
        /// `compression_format` of the metadata.
        format: String,
    },
    /// Messages that are not CDR.
    #[error(
        "{}: topic {} has serialization format \"{}\", only \"cdr\" can be read",
        shown(path),
        printable(topic),
        printable(format)
    )]
    UnsupportedSerialization {
        /// The bag.
        path: PathBuf,
        /// The topic.
        topic: String,
        /// What the bag says its messages are.
        format: String,
    },
    /// The bag has no such topic.
    #[error("{} has no topic {}; it has {}", shown(path), printable(topic), listed(existing))]
    NoTopic {
        /// The bag.
        path: PathBuf,
        /// The topic asked for.
        topic: String,
        /// The topics that exist.
        existing: Vec<String>,
    },
    /// The bag has several machines, each in a namespace.
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
        /// The topic asked for.
        topic: String,
        /// The damage that may be the reason, one line each; empty for a bag in good order.
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
        /// Type that can be read.
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
    /// No message of the topic can be decoded; this is about the first.
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
    /// A definition of a message type is not understood.
    #[error("{}: {}", printable(place), printable(&source.to_string()))]
    BadDefinition {
        /// The file, or the bag and topic.
        place: String,
        /// What is wrong with it.
        source: LayoutError,
    },
    /// A topic map, or what it asks for, is wrong.
    #[error("{}", printable(&_0.to_string()))]
    Map(#[from] MapError),
    /// A table that cannot be read.
    #[error("{}: {}", shown(path), printable(reason))]
    BadTable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it, and what to do.
        reason: String,
    },
    /// The place to write to is taken.
    #[error("{} exists already and is not overwritten; choose another name or remove it first", shown(path))]
    AlreadyExists {
        /// The path asked for.
        path: PathBuf,
    },
    /// A file that grows while it is made readable.
    #[error("{} is still being written; end its recorder first", shown(path))]
    StillWritten {
        /// The file.
        path: PathBuf,
    },
    /// What was written anew is not what was read; the original is as it was.
    #[error("the new {} does not have the messages of the original, which is left as it was", shown(path))]
    NotVerified {
        /// The file.
        path: PathBuf,
    },
    /// A bag that is to be replaced is none, or has files of others in it.
    #[error("{} is not replaced: {reason}; choose another name or remove it first", shown(path))]
    NotReplaceable {
        /// The path asked for.
        path: PathBuf,
        /// What is there.
        reason: String,
    },
    /// The disk is full, or the user's share of it.
    #[error(
        "no space left on the disk of {}: {bytes} bytes of the recording are written, what came after is lost; make room and \
         record again",
        shown(path)
    )]
    NoSpace {
        /// The file.
        path: PathBuf,
        /// Bytes of it that are written and can be read.
        bytes: u64,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// A bag needs a name.
    #[error("{} does not end with a name for the bag", shown(path))]
    NoName {
        /// The path asked for.
        path: PathBuf,
    },
    /// The recording breaks its own promises.
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
    /// The topic was added before with another type or definition.
    #[error(
        "topic {} is already in the bag as {}, it cannot be added as {}",
        printable(topic),
        printable(existing),
        printable(wanted)
    )]
    TopicConflict {
        /// The topic.
        topic: String,
        /// Type that it has.
        existing: String,
        /// Type that it should get.
        wanted: String,
    },
    /// A message was refused by its encoder.
    #[error("a message for topic {} cannot be encoded: {}", printable(topic), printable(reason))]
    Unencodable {
        /// The topic.
        topic: String,
        /// What the encoder says.
        reason: String,
    },
    /// The MCAP library refused to write.
    #[error("cannot write {}: {source}", shown(path))]
    Write {
        /// The file.
        path: PathBuf,
        /// What the library says.
        source: mcap::McapError,
    },
}

impl BagError {
    /// For `map_err` after an operation on `path`.
    pub(crate) fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> BagError {
        move |source| BagError::Io { action, path: path.to_path_buf(), source }
    }
}

/// A path for a terminal.
fn shown(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

fn listed(topics: &[String]) -> String {
    if topics.is_empty() { "no topics at all".to_string() } else { printable(&topics.join(", ")).into_owned() }
}

fn because(damage: &[String]) -> String {
    if damage.is_empty() { String::new() } else { format!(" ({})", printable(&in_short(damage))) }
}

/// The first lines and the last, which says where reading ended.
pub(crate) fn in_short(damage: &[String]) -> String {
    match damage {
        [first, second, others @ .., last] if !others.is_empty() => {
            format!("{first}; {second}; {} more damaged places; {last}", others.len())
        }
        few => few.join("; "),
    }
}
