//! Messages as bytes into a rosbag2 folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use excavator_msgs::{Message, definitions};

use super::options::WriteOptions;
use super::part::Part;
use crate::metadata::{Contents, FILE_NAME, FileContents, TopicContents};
use crate::{BagError, Qos};

/// A topic to be added to a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TopicToWrite {
    /// Name: `/arm/state`.
    pub name: String,
    /// Type of the messages: `excavator_msgs/msg/ArmState`.
    pub type_name: String,
    /// Definition of the type and of all types that it contains, `ros2msg`; see [`excavator_msgs::definitions`].
    pub schema: String,
    /// Quality of service that the publishers offer, one entry per publisher; may be empty.
    pub qos: Vec<Qos>,
}

impl TopicToWrite {
    /// A topic of one of our own messages.
    pub fn of<M: Message>(name: &str, qos: Qos) -> Self {
        TopicToWrite {
            name: name.to_string(),
            type_name: M::TYPE_NAME.to_string(),
            schema: definitions::schema(M::TYPE_NAME).unwrap_or_default(),
            qos: vec![qos],
        }
    }
}

/// A topic of the [`BagWriter`] that gave it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TopicId(usize);

/// Writes CDR messages of any type to a new rosbag2 folder: `NAME/NAME_0.mcap`, further files where [`WriteOptions`] limits
/// their size or length, and `NAME/metadata.yaml` at the end.
///
/// A chunk goes to the file only when it is whole, so a recorder that is killed loses what came after the last chunk
/// or [`BagWriter::flush`], and nothing before it. Dropping the writer closes the bag as [`BagWriter::finish`] does,
/// but cannot report errors.
pub struct BagWriter {
    folder: PathBuf,
    name: String,
    options: WriteOptions,
    /// The file that is being written; `None` once the bag is closed.
    part: Option<Part>,
    finished: Vec<FileContents>,
    topics: Vec<WrittenTopic>,
    custom_data: BTreeMap<String, String>,
}

struct WrittenTopic {
    topic: TopicToWrite,
    messages: u64,
}

impl BagWriter {
    /// Creates the folder, which must not exist yet, and in it an empty MCAP file.
    ///
    /// # Errors
    /// [`BagError::AlreadyExists`], [`BagError::NoName`], [`BagError::Io`], [`BagError::Write`].
    pub fn create(folder: &Path, options: &WriteOptions) -> Result<Self, BagError> {
        let name = folder.file_name().ok_or_else(|| BagError::NoName { path: folder.to_path_buf() })?;
        let name = name.to_string_lossy().into_owned();
        if let Some(parent) = folder.parent() {
            std::fs::create_dir_all(parent).map_err(BagError::io("create", parent))?;
        }
        // Creating and looking in one step: two recorders started at once must not share a folder.
        std::fs::create_dir(folder).map_err(|error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => BagError::AlreadyExists { path: folder.to_path_buf() },
            _ => BagError::io("create", folder)(error),
        })?;
        let part = Part::create(folder, file_name(&name, 0), options)?;
        Ok(BagWriter {
            folder: folder.to_path_buf(),
            name,
            options: options.clone(),
            part: Some(part),
            finished: Vec::new(),
            topics: Vec::new(),
            custom_data: options.custom_data.clone(),
        })
    }

    /// The folder of the bag.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Adds a topic. Adding the same topic again gives the same id.
    ///
    /// # Errors
    /// [`BagError::TopicConflict`] when the name has another type or definition already; [`BagError::Write`].
    pub fn add_topic(&mut self, topic: &TopicToWrite) -> Result<TopicId, BagError> {
        if let Some(index) = self.topics.iter().position(|known| known.topic.name == topic.name) {
            let known = &self.topics[index].topic;
            if known.type_name == topic.type_name && known.schema == topic.schema {
                return Ok(TopicId(index));
            }
            return Err(BagError::TopicConflict {
                topic: topic.name.clone(),
                existing: known.type_name.clone(),
                wanted: topic.type_name.clone(),
            });
        }
        self.part()?.add_topic(topic)?;
        self.topics.push(WrittenTopic { topic: topic.clone(), messages: 0 });
        Ok(TopicId(self.topics.len() - 1))
    }

    /// Writes one message: its bytes with encapsulation, and when it was received and published, ns since the epoch.
    ///
    /// # Errors
    /// [`BagError::Write`] when the file cannot be written, or the id is of another writer.
    pub fn write(&mut self, topic: TopicId, log_time: u64, publish_time: u64, data: &[u8]) -> Result<(), BagError> {
        if self.part.as_ref().is_some_and(|part| part.is_full(log_time, &self.options)) {
            self.begin_next_file()?;
        }
        // The recorder's own count per topic: gaps in it are gaps in the file.
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

    /// Closes the chunk and hands everything to the operating system, so that it survives the end of this process.
    ///
    /// # Errors
    /// [`BagError::Write`].
    pub fn flush(&mut self) -> Result<(), BagError> {
        self.part()?.flush()
    }

    /// Writes the index and `metadata.yaml`.
    ///
    /// # Errors
    /// [`BagError::Write`], [`BagError::Io`].
    pub fn finish(mut self) -> Result<(), BagError> {
        self.close()
    }

    /// Ends the file and goes on in another one that knows all topics, as readers of one file of a bag expect.
    fn begin_next_file(&mut self) -> Result<(), BagError> {
        let Some(part) = self.part.take() else { return Ok(()) };
        self.finished.push(part.finish()?);
        let mut part = Part::create(&self.folder, file_name(&self.name, self.finished.len()), &self.options)?;
        for written in &self.topics {
            part.add_topic(&written.topic)?;
        }
        self.part = Some(part);
        Ok(())
    }

    fn close(&mut self) -> Result<(), BagError> {
        let Some(part) = self.part.take() else { return Ok(()) };
        self.finished.push(part.finish()?);
        let topics: Vec<TopicContents> = self
            .topics
            .iter()
            .map(|written| TopicContents {
                name: written.topic.name.clone(),
                type_name: written.topic.type_name.clone(),
                qos: Qos::entries(&written.topic.qos),
                message_count: written.messages,
            })
            .collect();
        let contents =
            Contents { storage: "mcap", files: &self.finished, topics: &topics, custom_data: &self.custom_data };
        let path = self.folder.join(FILE_NAME);
        let text = contents.to_yaml().map_err(|error| BagError::Io {
            action: "write",
            path: path.clone(),
            source: std::io::Error::other(error),
        })?;
        std::fs::write(&path, text).map_err(BagError::io("write", &path))
    }

    /// The file that is being written, which is there as long as the bag is not closed and nothing failed.
    fn part(&mut self) -> Result<&mut Part, BagError> {
        let path = self.folder.clone();
        self.part.as_mut().ok_or(BagError::Write { path, source: mcap::McapError::AttemptedWriteAfterFailure })
    }
}

/// `NAME_0.mcap`, as rosbag2 names the files of a bag.
fn file_name(bag: &str, number: usize) -> String {
    format!("{bag}_{number}.mcap")
}

impl Drop for BagWriter {
    fn drop(&mut self) {
        // A drop has nobody to tell; finish() is there for those who want to know.
        let _ = self.close();
    }
}
