//! Writes messages as bytes to a rosbag2 folder.

use std::collections::BTreeMap;
use std::fs::Permissions;
use std::io::Write;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};

use super::gone::GoneFile;
use super::options::WriteOptions;
use super::part::{Location, Part, Written};
use super::reserve::Reserve;
use super::topic_to_write::TopicToWrite;
use crate::metadata::{BagCompression, Contents, FILE_NAME, FileContents, TopicContents};
use crate::{Error, Qos};

/// The id of a topic in the [`BagWriter`] that returned it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TopicId(usize);

/// Writes CDR messages of any type to a new rosbag2 folder: `NAME/NAME_0.mcap`, further files if [`WriteOptions`]
/// limits their size or duration, and `NAME/metadata.yaml` at the end.
///
/// Only complete chunks are written to the file, so a recorder that is killed loses only what came after the last chunk
/// or [`BagWriter::flush`]. Dropping the writer closes the bag as [`BagWriter::finish`] does, but cannot report errors.
pub struct BagWriter {
    folder: PathBuf,
    name: String,
    options: WriteOptions,
    /// The file being written; `None` once the bag is closed.
    part: Option<Part>,
    finished: Vec<(Location, Written)>,
    gone: Vec<GoneFile>,
    /// Number of files created so far.
    count: usize,
    /// Held until the bag is closed.
    reserve: Option<Reserve>,
    topics: Vec<WrittenTopic>,
    custom_data: BTreeMap<String, String>,
}

struct WrittenTopic {
    topic: TopicToWrite,
    messages: u64,
}

impl BagWriter {
    /// Creates the folder, which must not exist yet, and an empty MCAP file in it.
    ///
    /// # Errors
    /// [`Error::AlreadyExists`], [`Error::NoName`], [`Error::Io`], [`Error::Write`].
    pub fn create(folder: &Path, options: &WriteOptions) -> Result<Self, Error> {
        let name = folder.file_name().ok_or_else(|| Error::NoName { path: folder.to_path_buf() })?;
        let name = name.to_string_lossy().into_owned();
        if let Some(parent) = folder.parent() {
            std::fs::create_dir_all(parent).map_err(Error::io("create", parent))?;
        }
        // Checks and creates in one step: two recorders started at once must not share a folder.
        std::fs::create_dir(folder).map_err(|error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => Error::AlreadyExists { path: folder.to_path_buf() },
            _ => Error::io("create", folder)(error),
        })?;
        let opened = Reserve::take(folder)
            .and_then(|reserve| Ok((reserve, Part::create(folder, file_name(&name, 0), options)?)))
            // The folder contains only what failed.
            .inspect_err(|_| drop(std::fs::remove_dir_all(folder)));
        let (reserve, part) = opened?;
        Ok(BagWriter {
            folder: folder.to_path_buf(),
            name,
            options: options.clone(),
            part: Some(part),
            finished: Vec::new(),
            gone: Vec::new(),
            count: 1,
            reserve: Some(reserve),
            topics: Vec::new(),
            custom_data: options.custom_data.clone(),
        })
    }

    /// The folder of the bag.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Adds a topic. Adding the same topic again returns the same id.
    ///
    /// # Errors
    /// [`Error::TopicConflict`] if the name already has another type or definition; [`Error::Write`].
    pub fn add_topic(&mut self, topic: &TopicToWrite) -> Result<TopicId, Error> {
        if let Some(index) = self.topics.iter().position(|known| known.topic.name == topic.name) {
            let known = &self.topics[index].topic;
            if known.type_name == topic.type_name && known.schema == topic.schema {
                return Ok(TopicId(index));
            }
            return Err(Error::TopicConflict {
                topic: topic.name.clone(),
                existing: known.type_name.clone(),
                wanted: topic.type_name.clone(),
            });
        }
        self.part()?.add_topic(topic)?;
        self.topics.push(WrittenTopic { topic: topic.clone(), messages: 0 });
        Ok(TopicId(self.topics.len() - 1))
    }

    /// Writes one message: its bytes with encapsulation, its receive time and its publish time, ns since the epoch.
    ///
    /// # Errors
    /// [`Error::Write`] if the file cannot be written, or the id belongs to another writer.
    pub fn write(&mut self, topic: TopicId, log_time: u64, publish_time: u64, data: &[u8]) -> Result<(), Error> {
        if self.part.as_ref().is_some_and(|part| part.is_full(log_time, &self.options)) {
            self.begin_next_file()?;
        }
        // The recorder's own count per topic: a gap in it means that messages are missing in the file.
        let messages = self.topics.get(topic.0).map_or(0, |written| written.messages);
        let sequence = u32::try_from(messages & u64::from(u32::MAX)).unwrap_or_default();
        self.part()?.write(topic.0, sequence, log_time, publish_time, data)?;
        if let Some(written) = self.topics.get_mut(topic.0) {
            written.messages += 1;
        }
        Ok(())
    }

    /// Sets a pair of `custom_data` in `metadata.yaml`, which `ros2 bag info` shows.
    pub fn set_custom_data(&mut self, key: &str, value: &str) {
        self.custom_data.insert(key.to_string(), value.to_string());
    }

    /// Closes the chunk and passes all data to the operating system, so that it survives the end of this process.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn flush(&mut self) -> Result<(), Error> {
        self.part()?.flush()
    }

    /// Checks whether the current file is still where it was created. If not, it is closed, so that a moved file is
    /// complete, and the bag continues in another file in the folder of the same name.
    ///
    /// # Errors
    /// [`Error::Io`], [`Error::Write`] if no other file can be created.
    pub fn stay_in_place(&mut self) -> Result<Option<&GoneFile>, Error> {
        let Some(part) = self.part.take_if(|part| !part.location().is_kept()) else { return Ok(None) };
        self.end(part)?;
        std::fs::create_dir_all(&self.folder).map_err(Error::io("create", &self.folder))?;
        self.begin()?;
        self.note_gone();
        Ok(self.gone.last())
    }

    /// Writes the index and `metadata.yaml`. After a write failure, the bag is closed with the contents of the file at
    /// the last [`BagWriter::flush`]. Returns the files that were moved or deleted, and so are not in the metadata.
    ///
    /// # Errors
    /// [`Error::Write`], [`Error::Io`], [`Error::NoSpace`].
    pub fn finish(mut self) -> Result<Vec<GoneFile>, Error> {
        self.close()?;
        Ok(std::mem::take(&mut self.gone))
    }

    /// Closes the file and continues in a new one with all topics, as readers of a single file of a bag expect.
    fn begin_next_file(&mut self) -> Result<(), Error> {
        let Some(part) = self.part.take() else { return Ok(()) };
        self.end(part)?;
        self.begin()
    }

    fn end(&mut self, part: Part) -> Result<(), Error> {
        let location = part.location().clone();
        let (written, outcome) = part.finish();
        self.finished.push((location, written));
        outcome
    }

    fn begin(&mut self) -> Result<(), Error> {
        let mut part = Part::create(&self.folder, file_name(&self.name, self.count), &self.options)?;
        self.count += 1;
        for written in &self.topics {
            part.add_topic(&written.topic)?;
        }
        self.part = Some(part);
        Ok(())
    }

    /// Removes files that were moved or deleted from the bag.
    fn note_gone(&mut self) {
        let gone = self.finished.extract_if(.., |(location, _)| !location.is_kept());
        self.gone.extend(gone.map(|(location, written)| GoneFile::new(&location, written)));
    }

    fn close(&mut self) -> Result<(), Error> {
        let Some(reserve) = self.reserve.take() else { return Ok(()) };
        // The reserved space is for the end of the file and the metadata.
        drop(reserve);
        let ended = self.part.take().map_or(Ok(()), |part| self.end(part));
        self.note_gone();
        if self.finished.is_empty() && !self.folder.is_dir() {
            return ended;
        }
        let described = self.describe();
        ended.and(described)
    }

    /// Writes `metadata.yaml`.
    fn describe(&self) -> Result<(), Error> {
        let count = |topic: usize| self.finished.iter().filter_map(|(_, file)| file.by_topic.get(topic)).sum();
        let topics: Vec<TopicContents> = self
            .topics
            .iter()
            .enumerate()
            .map(|(index, written)| TopicContents {
                name: written.topic.name.clone(),
                type_name: written.topic.type_name.clone(),
                qos: Qos::entries(&written.topic.qos),
                message_count: count(index),
            })
            .collect();
        let files: Vec<FileContents> = self.finished.iter().map(|(_, file)| file.contents.clone()).collect();
        let (custom_data, compression) = (&self.custom_data, BagCompression::None);
        let contents = Contents { storage: "mcap", files: &files, topics: &topics, custom_data, compression };
        let path = self.folder.join(FILE_NAME);
        let text = contents.to_yaml().map_err(|error| Error::Io {
            action: "write",
            path: path.clone(),
            source: std::io::Error::other(error),
        })?;
        let written = || {
            let mut file = tempfile::Builder::new()
                .prefix(".metadata-")
                .permissions(Permissions::from_mode(0o666))
                .tempfile_in(&self.folder)?;
            file.write_all(text.as_bytes())?;
            file.as_file().sync_all()?;
            file.persist(&path)?;
            Ok(())
        };
        written().map_err(Error::io("write", &path))
    }

    /// The file being written; it exists unless the bag is closed or an operation failed.
    fn part(&mut self) -> Result<&mut Part, Error> {
        let path = self.folder.clone();
        self.part.as_mut().ok_or(Error::Write { path, source: mcap::McapError::AttemptedWriteAfterFailure })
    }
}

/// `NAME_0.mcap`, the file naming of rosbag2.
fn file_name(bag: &str, number: usize) -> String {
    format!("{bag}_{number}.mcap")
}

impl Drop for BagWriter {
    fn drop(&mut self) {
        // Drop cannot report an error; callers that need it use finish().
        let _ = self.close();
    }
}
