//! The messages of a file that every reader can read: as they are stored, without those that cannot be decompressed.

use std::path::{Path, PathBuf};

use crate::storage::{MessageDecompressor, StorageFile};
use crate::{Damage, Error, RawMessage, ReadLimits};

/// One file that is read for a copy.
pub(super) struct Readable {
    path: PathBuf,
    file: StorageFile,
    decompressor: MessageDecompressor,
}

impl Readable {
    pub fn open(path: &Path, limits: &ReadLimits) -> Result<Readable, Error> {
        let (path, file) = (path.to_path_buf(), StorageFile::open(path, limits)?);
        Ok(Readable { path, file, decompressor: MessageDecompressor::new(limits) })
    }

    pub fn file(&self) -> &StorageFile {
        &self.file
    }

    /// The next message as it is stored, `None` at the end.
    ///
    /// # Errors
    /// Only errors of the operating system.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, Error> {
        while let Some(message) = self.file.next_message()? {
            if self.decompressor.decompress(message.data.clone()).is_some() {
                return Ok(Some(message));
            }
        }
        Ok(None)
    }

    /// The damage found so far; complete after the last message.
    pub fn damage(&self) -> Vec<Damage> {
        self.file.damage().cloned().chain(self.decompressor.damage(&self.path)).collect()
    }
}
