//! The messages of a bag as bytes, of any type.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bytes::Bytes;

use crate::in_short;
use crate::location::BagFiles;
use crate::storage::{MessageDecompressor, StorageFile};
use crate::{Damage, Error, Qos, ReadLimits};

/// A topic as the bag defines it.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Topic {
    /// Name: `/joint_states`.
    pub name: String,
    /// Type of the messages: `sensor_msgs/msg/JointState`; empty if the bag does not contain it.
    pub type_name: String,
    /// Language of the definition: `ros2msg` or `ros2idl`; empty when the bag has no definition.
    pub schema_encoding: String,
    /// Definition of the type and of all types that it contains.
    pub schema: String,
    /// Serialization of the messages: `cdr`.
    pub message_encoding: String,
    /// QoS that the publishers offered, in the YAML of the bag; see [`Topic::qos`].
    pub offered_qos_profiles: String,
}

impl Topic {
    /// QoS that the publishers offered; empty if the bag does not contain it.
    #[must_use]
    pub fn qos(&self) -> Vec<Qos> {
        Qos::list_from_yaml(&self.offered_qos_profiles)
    }
}

/// One message as bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawMessage {
    /// The topic; all messages of a topic within one file share it.
    pub topic: Arc<Topic>,
    /// Number assigned by the recorder or the publisher; often 0.
    pub sequence: u32,
    /// When the recorder received the message, ns since the epoch.
    pub log_time: u64,
    /// When the message was published, ns since the epoch; equal to `log_time` if the recorder does not know it.
    pub publish_time: u64,
    /// The message with its four bytes of encapsulation. A slice of the decompressed chunk of an MCAP file: cheap to
    /// clone, but it keeps the whole chunk in memory.
    pub data: Bytes,
}

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
    /// If there is no bag, or a bag of an unsupported kind: [`Error::DoesNotExist`], [`Error::NotABag`],
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
