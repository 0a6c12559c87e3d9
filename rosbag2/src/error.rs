//! Why a bag cannot be read or written.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::dynamic::LayoutError;
use crate::limits::LimitError;
use crate::{printable, printable_path as shown};

/// A bag that cannot be read or written at all. Damage that can be read around is no error but a
/// [`Damage`](crate::Damage) in the report.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Error {
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
    /// A definition of a message type is not understood.
    #[error("{}: {}", printable(place), printable(&source.to_string()))]
    BadDefinition {
        /// The file, or the bag and topic.
        place: String,
        /// What is wrong with it.
        source: LayoutError,
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
    /// The MCAP library refused to write.
    #[error("cannot write {}: {source}", shown(path))]
    Write {
        /// The file.
        path: PathBuf,
        /// What the library says.
        source: mcap::McapError,
    },
}

impl Error {
    /// For `map_err` after an operation of the operating system on `path`: gives [`Error::Io`].
    pub fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Error {
        move |source| Error::Io { action, path: path.to_path_buf(), source }
    }
}

/// Lines of damage as one: the first two and the last, which says where reading ended, with the number of those between.
#[must_use]
pub fn in_short(damage: &[String]) -> String {
    match damage {
        [first, second, others @ .., last] if !others.is_empty() => {
            format!("{first}; {second}; {} more damaged places; {last}", others.len())
        }
        few => few.join("; "),
    }
}
