//! The messages of a bag as bytes, of any type.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::in_short;
use crate::location::BagFiles;
use crate::raw_message::{RawMessage, Topic};
use crate::storage::{MessageDecompressor, StorageFile};
use crate::{Damage, Error, ReadLimits};

/// Iterator over all messages of a bag in the order in which they were written, file after file.
///
/// Damage does not end the iteration; it is collected in [`RawMessages::damage`]. One chunk of an MCAP file, or about 1
/// MB of a SQLite3 file, is in memory at a time.
#[derive(Debug)]
#[must_use = "nothing is read before it is iterated over"]
pub struct RawMessages {
    path: PathBuf,
    waiting: VecDeque<StorageFile>,
    done: Vec<StorageFile>,
    decompressor: MessageDecompressor,
    promised_messages: Option<u64>,
    file_bytes: u64,
    limits: ReadLimits,
}

impl RawMessages {
    /// Opens the bag at `path`: a rosbag2 folder, or a bare `.mcap` or `.db3` file; MCAP or SQLite3, also compressed
    /// with zstd by rosbag2.
    ///
    /// # Errors
    /// When there is no bag, or one of a kind that cannot be read: [`Error::DoesNotExist`], [`Error::NotABag`],
    /// [`Error::BadMetadata`], [`Error::MissingFile`], [`Error::UnsupportedStorage`],
    /// [`Error::UnsupportedCompression`], [`Error::UnsupportedSerialization`], [`Error::NotARegularFile`],
    /// [`Error::Limit`], [`Error::Io`].
    pub fn open(path: &Path) -> Result<Self, Error> {
        RawMessages::open_within(path, &ReadLimits::DEFAULT)
    }

    /// As [`RawMessages::open`], with other limits.
    ///
    /// # Errors
    /// As [`RawMessages::open`].
    pub fn open_within(path: &Path, limits: &ReadLimits) -> Result<Self, Error> {
        let BagFiles { files, promised_messages } = BagFiles::locate(path, limits)?;
        let mut waiting = VecDeque::new();
        for file in &files {
            waiting.push_back(StorageFile::open(file, limits)?);
        }
        if !waiting.is_empty() && waiting.iter().all(StorageFile::is_unreadable) {
            let damage: Vec<String> = waiting.iter().flat_map(StorageFile::damage).map(ToString::to_string).collect();
            return Err(Error::NotABag { path: path.to_path_buf(), reason: in_short(&damage) });
        }
        let lengths = files.iter().filter_map(|file| std::fs::metadata(file).ok()).map(|metadata| metadata.len());
        Ok(RawMessages {
            path: path.to_path_buf(),
            file_bytes: lengths.fold(0, u64::saturating_add),
            waiting,
            done: Vec::new(),
            decompressor: MessageDecompressor::new(limits),
            promised_messages,
            limits: *limits,
        })
    }

    /// The path that was opened.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The topics known so far, each name once, sorted. At the start these are all topics if the files have a summary;
    /// after the last message they are always complete.
    #[must_use]
    pub fn topics(&self) -> Vec<Arc<Topic>> {
        let mut topics: Vec<Arc<Topic>> =
            self.done.iter().chain(&self.waiting).flat_map(StorageFile::topics).cloned().collect();
        topics.sort_by(|a, b| a.name.cmp(&b.name));
        topics.dedup_by(|a, b| a.name == b.name);
        topics
    }

    /// The damage found so far; complete after the last message.
    #[must_use]
    pub fn damage(&self) -> Vec<Damage> {
        let read = self.done.iter().chain(&self.waiting).flat_map(StorageFile::damage);
        read.cloned().chain(self.decompressor.damage(&self.path)).collect()
    }

    /// Checks the memory that the caller needs for data derived from the messages so far, bytes, against the limits and
    /// the size of the bag's files.
    ///
    /// # Errors
    /// [`Error::Limit`].
    pub fn check_memory(&self, needed: u64) -> Result<(), Error> {
        self.limits
            .check_memory(needed, self.file_bytes)
            .map_err(|source| Error::Limit { path: self.path.clone(), source })
    }

    /// Number of messages that `metadata.yaml` declares; `None` without metadata.
    pub fn promised_messages(&self) -> Option<u64> {
        self.promised_messages
    }
}

impl Iterator for RawMessages {
    type Item = Result<RawMessage, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let file = self.waiting.front_mut()?;
            match file.next_message() {
                Ok(Some(mut message)) => {
                    if let Some(data) = self.decompressor.decompress(std::mem::take(&mut message.data)) {
                        message.data = data;
                        return Some(Ok(message));
                    }
                }
                Ok(None) => self.done.extend(self.waiting.pop_front()),
                Err(error) => {
                    // Reading again would fail with the same error: this file is finished.
                    self.done.extend(self.waiting.pop_front());
                    return Some(Err(error));
                }
            }
        }
    }
}
