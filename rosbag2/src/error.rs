//! Errors when reading or writing a bag.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::dynamic::LayoutError;
use crate::limits::LimitError;
use crate::{printable, printable_path as shown};

/// A bag that cannot be read or written at all. Damage that can be skipped is not an error but a
/// [`Damage`](crate::Damage) in the report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
    /// The path does not exist.
    #[error("{} does not exist", shown(path))]
    DoesNotExist {
        /// The requested path.
        path: PathBuf,
    },
    /// A read or write error of the operating system.
    #[error("cannot {action} {}: {source}", shown(path))]
    Io {
        /// The attempted action: "read", "create", ...
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A FIFO, a device, a socket, or a folder in place of a file.
    #[error("{} is not a regular file but {}; give a file", shown(path), printable(found))]
    NotARegularFile {
        /// The requested path.
        path: PathBuf,
        /// The kind of file found: "a FIFO", "a device", ...
        found: &'static str,
    },
    /// A file that exceeds [`ReadLimits`](crate::ReadLimits).
    #[error("{}: {source}", shown(path))]
    Limit {
        /// The file.
        path: PathBuf,
        /// The limit, with the values found and allowed.
        source: LimitError,
    },
    /// A folder without any file of a bag, or a file that is not a bag.
    #[error("{} is not a bag: {}; give a rosbag2 folder, an .mcap or a .db3 file", shown(path), printable(reason))]
    NotABag {
        /// The requested path.
        path: PathBuf,
        /// What was found instead.
        reason: String,
    },
    /// `metadata.yaml` is not in the format of rosbag2.
    #[error("{}: {}; move the file away to read the bag without it", shown(path), printable(reason))]
    BadMetadata {
        /// Path of `metadata.yaml`.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// `metadata.yaml` lists a file that does not exist.
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
        /// Name of the storage in the metadata.
        storage: String,
    },
    /// A kind of file that this build cannot read.
    #[error("{}: reading {what} needs a build with the feature `{feature}`", shown(path))]
    NeedsFeature {
        /// The file.
        path: PathBuf,
        /// What kind of file it is: "SQLite3", ".parquet".
        what: &'static str,
        /// Name of the feature.
        feature: &'static str,
    },
    /// Files or messages that rosbag2 compressed with something other than zstd.
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
        /// The serialization format that the bag declares.
        format: String,
    },
    /// A definition of a message type that cannot be parsed.
    #[error("{}: {}", printable(place), printable(&source.to_string()))]
    BadDefinition {
        /// The file, or the bag and topic.
        place: String,
        /// What is wrong with it.
        source: LayoutError,
    },
    /// The target path already exists.
    #[error("{} exists already and is not overwritten; choose another name or remove it first", shown(path))]
    AlreadyExists {
        /// The requested path.
        path: PathBuf,
    },
    /// A file that grows during reindexing.
    #[error("{} is still being written; end its recorder first", shown(path))]
    StillWritten {
        /// The file.
        path: PathBuf,
    },
    /// The rewritten file does not match what was read; the original is unchanged.
    #[error("the new {} does not have the messages of the original, which is left as it was", shown(path))]
    NotVerified {
        /// The file.
        path: PathBuf,
    },
    /// A bag that is read back after it was written anew, and does not have all messages.
    #[error(
        "{} is written anew, but has {found} messages when it is read back, not {expected}; keep the originals and report this",
        shown(path)
    )]
    NotReadBack {
        /// The bag.
        path: PathBuf,
        /// Messages that can be read.
        found: u64,
        /// Messages that were written.
        expected: u64,
    },
    /// Messages of which only some are compressed, or that are compressed twice.
    #[error(
        "{}: {compressed} of {messages} messages are compressed by themselves, and no metadata can say so; record or convert \
         the two parts into bags of their own",
        shown(path)
    )]
    MixedCompression {
        /// The bag.
        path: PathBuf,
        /// Compressed messages.
        compressed: u64,
        /// All messages.
        messages: u64,
    },
    /// A bag to be replaced is not a bag, or contains other files.
    #[error("{} is not replaced: {reason}; choose another name or remove it first", shown(path))]
    NotReplaceable {
        /// The requested path.
        path: PathBuf,
        /// What was found there.
        reason: String,
    },
    /// The disk is full, or the user's quota is used up.
    #[error(
        "no space left on the disk of {}: {bytes} bytes of the recording are written, what came after is lost; make room and \
         record again",
        shown(path)
    )]
    NoSpace {
        /// The file.
        path: PathBuf,
        /// Bytes that are written and readable.
        bytes: u64,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// A bag needs a name.
    #[error("{} does not end with a name for the bag", shown(path))]
    NoName {
        /// The requested path.
        path: PathBuf,
    },
    /// The topic was already added with another type or definition.
    #[error(
        "topic {} is already in the bag as {}, it cannot be added as {}",
        printable(topic),
        printable(existing),
        printable(wanted)
    )]
    TopicConflict {
        /// The topic.
        topic: String,
        /// Its existing type.
        existing: String,
        /// The requested type.
        wanted: String,
    },
    /// The MCAP library failed to write.
    #[error("cannot write {}: {source}", shown(path))]
    Write {
        /// The file.
        path: PathBuf,
        /// The error of the library.
        source: mcap::McapError,
    },
}

impl Error {
    /// For `map_err` after a file operation on `path`: returns [`Error::Io`].
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Error {
        move |source| Error::Io { action, path: path.to_path_buf(), source }
    }
}

/// Joins damage lines into one: the first two and the last, where reading ended, with the number of lines left out.
#[must_use]
pub fn in_short(damage: &[String]) -> String {
    match damage {
        [first, second, others @ .., last] if !others.is_empty() => {
            format!("{first}; {second}; {} more damaged places; {last}", others.len())
        }
        few => few.join("; "),
    }
}
