//! One face for the storages of rosbag2: whatever a file is, it gives topics, messages and damage.

mod compressed;
mod sqlite_file;
mod sqlite_query;
mod sqlite_skip;

use std::path::Path;
use std::sync::Arc;

use crate::container::{Damage, DamageKind, McapFile};
use crate::raw_messages::{RawMessage, Topic};
use crate::{BagError, location};

pub(crate) use compressed::{MessageDecompressor, is_zstd};
use sqlite_file::SqliteFile;

/// One open file of a bag.
#[derive(Debug)]
pub(crate) struct StorageFile {
    kind: Kind,
    /// The unpacked copy of a file that rosbag2 compressed as a whole; removed when dropped.
    _unpacked: Option<tempfile::TempPath>,
    /// What is wrong with the compression of the whole file.
    compression_damage: Vec<Damage>,
}

#[derive(Debug)]
enum Kind {
    Mcap(Box<McapFile>),
    Sqlite(Box<SqliteFile>),
    /// Not one message can be won.
    Nothing,
}

impl StorageFile {
    /// Opens a file as what its first bytes say that it is. A file of which nothing can be read is damage, no error.
    pub fn open(path: &Path) -> Result<StorageFile, BagError> {
        if !is_zstd(&location::first_bytes(path)?) {
            return Ok(match open_plain(path, path)? {
                Ok(kind) => StorageFile { kind, _unpacked: None, compression_damage: Vec::new() },
                Err(damage) => StorageFile::nothing(vec![damage]),
            });
        }
        let (unpacked, fault) = compressed::unpack(path)?;
        let mut damage: Vec<Damage> = fault.into_iter().collect();
        match open_plain(&unpacked, path)? {
            Ok(kind) => Ok(StorageFile { kind, _unpacked: Some(unpacked), compression_damage: damage }),
            Err(fault) => {
                damage.push(fault);
                Ok(StorageFile::nothing(damage))
            }
        }
    }

    fn nothing(damage: Vec<Damage>) -> StorageFile {
        StorageFile { kind: Kind::Nothing, _unpacked: None, compression_damage: damage }
    }

    /// Whether not one message can be won from the file.
    pub fn is_unreadable(&self) -> bool {
        matches!(self.kind, Kind::Nothing)
    }

    /// The topics known so far.
    pub fn topics(&self) -> Vec<&Arc<Topic>> {
        match &self.kind {
            Kind::Mcap(file) => file.topics().collect(),
            Kind::Sqlite(file) => file.topics().collect(),
            Kind::Nothing => Vec::new(),
        }
    }

    /// The damage met so far; complete once [`StorageFile::next_message`] has returned `None`.
    pub fn damage(&self) -> impl Iterator<Item = &Damage> {
        let own = match &self.kind {
            Kind::Mcap(file) => file.damage(),
            Kind::Sqlite(file) => file.damage(),
            Kind::Nothing => &[],
        };
        self.compression_damage.iter().chain(own)
    }

    /// The next message, `None` at the end. Damage is noted and passed over.
    ///
    /// # Errors
    /// Only what the operating system refuses.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, BagError> {
        match &mut self.kind {
            Kind::Mcap(file) => file.next_message(),
            Kind::Sqlite(file) => Ok(file.next_message()),
            Kind::Nothing => Ok(None),
        }
    }
}

/// Opens the file at `path`, which people know as `name`.
fn open_plain(path: &Path, name: &Path) -> Result<Result<Kind, Damage>, BagError> {
    let length = std::fs::metadata(path).map_err(BagError::io("read", path))?.len();
    let nothing = |kind| Damage { file: name.to_path_buf(), offset: 0, lost_bytes: length, readable_until: None, kind };
    if location::first_bytes(path)?.starts_with(location::SQLITE_MAGIC) {
        return Ok(match SqliteFile::open(path, name) {
            Ok(file) => Ok(Kind::Sqlite(Box::new(file))),
            Err(reason) => Err(nothing(DamageKind::BadDatabase { reason })),
        });
    }
    Ok(match McapFile::open(path, name)? {
        Some(file) => Ok(Kind::Mcap(Box::new(file))),
        None => Err(nothing(DamageKind::UnknownFormat)),
    })
}
