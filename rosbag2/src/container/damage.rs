//! The parts of a file that could not be read.

use std::fmt;
use std::path::PathBuf;

use serde::Serialize;

use crate::printable;

/// One damaged place of one file, and what it cost.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Damage {
    /// The file.
    pub file: PathBuf,
    /// Where the damage begins, bytes from the start of the file; 0 where SQLite does not tell.
    pub offset: u64,
    /// Bytes lost: those that are there but of no use, plus those that are announced but not there; 0 where only the
    /// messages lost can be counted.
    pub lost_bytes: u64,
    /// Log time of the last message before the damage, ns since the epoch; `None` when there is none.
    pub readable_until: Option<u64>,
    /// What is wrong.
    pub kind: DamageKind,
}

/// What is wrong with a damaged place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DamageKind {
    /// The file is neither MCAP nor SQLite3, or empty.
    UnknownFormat,
    /// A SQLite3 file of which not even the topics can be read.
    BadDatabase {
        /// What SQLite says.
        reason: String,
    },
    /// A SQLite3 file that is shorter than its header says.
    CutDatabase,
    /// Rows of a SQLite3 file that cannot be read.
    LostRows {
        /// Number of the first of them; writers number rows from 1.
        first: i64,
        /// How many; `None` when nothing can be read after them, so that nobody knows.
        messages: Option<u64>,
        /// What SQLite says.
        reason: String,
    },
    /// A file that was compressed as a whole and cannot be decompressed to its end.
    BadCompression {
        /// What zstd says.
        reason: String,
        /// Bytes that were decompressed before.
        unpacked: u64,
    },
    /// Messages that were compressed one by one and cannot be decompressed.
    BadMessages {
        /// How many.
        messages: u64,
        /// What zstd says of the first.
        reason: String,
    },
    /// The file ends in the middle of a record, as after a power cut or an interrupted copy.
    CutOff {
        /// Messages that were still won from the cut chunk; without checksum, since that covers the whole chunk.
        recovered_messages: u64,
    },
    /// All messages are whole, but the end of a closed file is missing: no message is known to be lost.
    NotClosed,
    /// A chunk that cannot be trusted was left out.
    BadChunk {
        /// Checksum, compression or structure.
        reason: String,
    },
    /// A record outside chunks, or one definition of a topic, makes no sense.
    BadRecord {
        /// What makes no sense.
        reason: String,
    },
    /// The chain of records is broken; reading went on at the next chunk in the index, or ended for want of one.
    LostSync,
    /// Messages whose topic was defined in a place that is lost.
    UnknownTopic {
        /// How many.
        messages: u64,
    },
    /// The file unpacks to more than any recording does; it was read up to there.
    UnpacksWithoutEnd {
        /// Bytes unpacked, and what is allowed for a file of that size.
        reason: String,
    },
    /// More damaged places than are listed.
    More {
        /// How many.
        places: u64,
    },
}

impl Damage {
    /// Whether the end of the file is missing, as opposed to a hole in the middle.
    #[must_use]
    pub fn is_truncation(&self) -> bool {
        matches!(
            self.kind,
            DamageKind::CutOff { .. }
                | DamageKind::NotClosed
                | DamageKind::CutDatabase
                | DamageKind::BadCompression { .. }
        )
    }
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Damage { file, offset, lost_bytes, kind, .. } = self;
        let name = file.display().to_string();
        let file = printable(&name);
        match kind {
            DamageKind::UnknownFormat => {
                write!(f, "{file} is neither an MCAP nor a SQLite3 file: {lost_bytes} bytes left out")
            }
            DamageKind::BadDatabase { reason } => {
                write!(f, "{file} is a SQLite3 file that cannot be read, {lost_bytes} bytes lost: {reason}")
            }
            DamageKind::CutDatabase => {
                write!(f, "{file} is cut off at byte {offset}: {lost_bytes} bytes are missing")
            }
            DamageKind::LostRows { first, messages: Some(messages), reason } => {
                write!(f, "{file}: {messages} messages from number {first} on cannot be read: {reason}")
            }
            DamageKind::LostRows { first, messages: None, reason } => {
                write!(f, "{file}: no message from number {first} on can be read: {reason}")
            }
            DamageKind::BadCompression { reason, unpacked } => {
                write!(f, "{file} was decompressed to {unpacked} bytes, its end is lost: {reason}")
            }
            DamageKind::BadMessages { messages, reason } => {
                write!(
                    f,
                    "{file}: {messages} compressed messages cannot be decompressed, {lost_bytes} bytes lost: {reason}"
                )
            }
            DamageKind::CutOff { recovered_messages } => write!(
                f,
                "{file} is cut off in the record at byte {offset}: {lost_bytes} bytes lost, {recovered_messages} messages \
                 recovered from the cut chunk"
            ),
            DamageKind::NotClosed => {
                write!(f, "{file} was not closed: its data ends at byte {offset} after a whole record")
            }
            DamageKind::BadChunk { reason } => {
                write!(f, "{file}: chunk at byte {offset} left out, {lost_bytes} bytes lost: {reason}")
            }
            DamageKind::BadRecord { reason } => {
                write!(f, "{file}: record at byte {offset} left out, {lost_bytes} bytes lost: {reason}")
            }
            DamageKind::LostSync => write!(f, "{file}: no valid records at byte {offset}, {lost_bytes} bytes lost"),
            DamageKind::UnpacksWithoutEnd { reason } => {
                write!(f, "{file} was read up to byte {offset}, {lost_bytes} bytes left out: {reason}")
            }
            DamageKind::More { places } => {
                write!(f, "{file}: {places} more damaged places from byte {offset} on, {lost_bytes} bytes lost")
            }
            DamageKind::UnknownTopic { messages } => {
                write!(
                    f,
                    "{file}: {messages} messages left out, {lost_bytes} bytes lost: the definition of their topic is lost"
                )
            }
        }
    }
}
