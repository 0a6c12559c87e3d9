//! A common interface to the storages of rosbag2: topics, messages and damage.

mod compressed;
#[cfg(feature = "sqlite")]
mod sqlite_connection;
#[cfg(feature = "sqlite")]
mod sqlite_file;
#[cfg(feature = "sqlite")]
mod sqlite_query;
#[cfg(feature = "sqlite")]
mod sqlite_skip;

use std::path::Path;
use std::sync::Arc;

use crate::container::{Damage, DamageKind, McapFile};
use crate::limits::ReadLimits;
use crate::raw_message::{RawMessage, Topic};
use crate::{Error, location};

pub(crate) use compressed::{MessageDecompressor, is_zstd};
#[cfg(feature = "sqlite")]
use sqlite_file::SqliteFile;

/// One open file of a bag.
#[derive(Debug)]
pub(crate) struct StorageFile {
    kind: Kind,
    /// The unpacked copy of a file that rosbag2 compressed as a whole; removed when dropped.
    unpacked_copy: Option<tempfile::TempPath>,
    /// Damage in the compression of the whole file.
    compression_damage: Vec<Damage>,
}

/// The storages of rosbag2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StorageKind {
    Mcap,
    #[cfg(feature = "sqlite")]
    Sqlite,
}

impl StorageKind {
    /// The name in `metadata.yaml`.
    pub fn name(self) -> &'static str {
        match self {
            StorageKind::Mcap => "mcap",
            #[cfg(feature = "sqlite")]
            StorageKind::Sqlite => "sqlite3",
        }
    }
}

#[derive(Debug)]
enum Kind {
    Mcap(Box<McapFile>),
    #[cfg(feature = "sqlite")]
    Sqlite(Box<SqliteFile>),
    /// No message can be read.
    Nothing,
}

impl StorageFile {
    /// Opens a file in the format that its first bytes indicate. An unreadable file is damage, not an error.
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<StorageFile, Error> {
        if !is_zstd(&location::first_bytes(path)?) {
            return Ok(match open_plain(path, path, limits)? {
                Ok(kind) => StorageFile { kind, unpacked_copy: None, compression_damage: Vec::new() },
                Err(damage) => StorageFile::nothing(vec![damage]),
            });
        }
        let (unpacked, fault) = compressed::unpack(path, limits)?;
        let mut damage: Vec<Damage> = fault.into_iter().collect();
        match open_plain(&unpacked, path, limits)? {
            Ok(kind) => Ok(StorageFile { kind, unpacked_copy: Some(unpacked), compression_damage: damage }),
            Err(fault) => {
                damage.push(fault);
                Ok(StorageFile::nothing(damage))
            }
        }
    }

    fn nothing(damage: Vec<Damage>) -> StorageFile {
        StorageFile { kind: Kind::Nothing, unpacked_copy: None, compression_damage: damage }
    }

    /// Whether no message can be read from the file.
    pub fn is_unreadable(&self) -> bool {
        matches!(self.kind, Kind::Nothing)
    }

    /// The storage of the file; `None` if nothing can be read.
    pub fn kind(&self) -> Option<StorageKind> {
        match &self.kind {
            Kind::Mcap(_) => Some(StorageKind::Mcap),
            #[cfg(feature = "sqlite")]
            Kind::Sqlite(_) => Some(StorageKind::Sqlite),
            Kind::Nothing => None,
        }
    }

    /// Whether rosbag2 compressed the whole file.
    pub fn is_compressed(&self) -> bool {
        self.unpacked_copy.is_some()
    }

    /// Whether it ends with the index that other readers need; in SQLite3 the index is part of the file.
    pub fn has_index(&self) -> bool {
        match &self.kind {
            Kind::Mcap(file) => file.has_index(),
            #[cfg(feature = "sqlite")]
            Kind::Sqlite(_) => true,
            Kind::Nothing => false,
        }
    }

    /// The topics known so far.
    pub fn topics(&self) -> Vec<&Arc<Topic>> {
        match &self.kind {
            Kind::Mcap(file) => file.topics().collect(),
            #[cfg(feature = "sqlite")]
            Kind::Sqlite(file) => file.topics().collect(),
            Kind::Nothing => Vec::new(),
        }
    }

    /// The damage found so far; complete once [`StorageFile::next_message`] has returned `None`.
    pub fn damage(&self) -> impl Iterator<Item = &Damage> {
        let own = match &self.kind {
            Kind::Mcap(file) => file.damage(),
            #[cfg(feature = "sqlite")]
            Kind::Sqlite(file) => file.damage(),
            Kind::Nothing => &[],
        };
        self.compression_damage.iter().chain(own)
    }

    /// The next message, `None` at the end. Damage is recorded and skipped.
    ///
    /// # Errors
    /// Only errors of the operating system.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, Error> {
        match &mut self.kind {
            Kind::Mcap(file) => file.next_message(),
            #[cfg(feature = "sqlite")]
            Kind::Sqlite(file) => Ok(file.next_message()),
            Kind::Nothing => Ok(None),
        }
    }
}

/// Opens the file at `path`; messages call it `name`.
fn open_plain(path: &Path, name: &Path, limits: &ReadLimits) -> Result<Result<Kind, Damage>, Error> {
    let length = std::fs::metadata(path).map_err(Error::io("read", path))?.len();
    let nothing = |kind| Damage { file: name.to_path_buf(), offset: 0, lost_bytes: length, readable_until: None, kind };
    if location::first_bytes(path)?.starts_with(location::SQLITE_MAGIC) {
        #[cfg(feature = "sqlite")]
        return Ok(match SqliteFile::open(path, name, limits) {
            Ok(file) => Ok(Kind::Sqlite(Box::new(file))),
            Err(reason) => Err(nothing(DamageKind::BadDatabase { reason })),
        });
        #[cfg(not(feature = "sqlite"))]
        return Err(Error::NeedsFeature { path: name.to_path_buf(), what: "SQLite3", feature: "sqlite" });
    }
    Ok(match McapFile::open(path, name, limits)? {
        Some(file) => Ok(Kind::Mcap(Box::new(file))),
        None => Err(nothing(DamageKind::UnknownFormat)),
    })
}
