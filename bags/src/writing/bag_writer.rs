//! Messages as bytes into a rosbag2 folder.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

use excavator_msgs::{Message, definitions};
use mcap::records::MessageHeader;

use super::options::WriteOptions;
use crate::metadata::{Contents, FILE_NAME, TopicContents};
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

/// Writes CDR messages of any type to a new rosbag2 folder: `NAME/NAME_0.mcap`, and `NAME/metadata.yaml` at the end.
///
/// A chunk goes to the file only when it is whole, so a recorder that is killed loses what came after the last chunk
/// or [`BagWriter::flush`], and nothing before it. Dropping the writer closes the bag as [`BagWriter::finish`] does,
/// but cannot report errors.
pub struct BagWriter {
    folder: PathBuf,
    file_name: String,
    /// `None` once the bag is closed.
    mcap: Option<mcap::Writer<BufWriter<File>>>,
    topics: Vec<WrittenTopic>,
    span: Option<(u64, u64)>,
    custom_data: BTreeMap<String, String>,
}

struct WrittenTopic {
    topic: TopicToWrite,
    channel: u16,
    messages: u64,
}

impl BagWriter {
    /// Creates the folder, which must not exist yet, and in it an empty MCAP file.
    ///
    /// # Errors
    /// [`BagError::AlreadyExists`], [`BagError::NoName`], [`BagError::Io`], [`BagError::Write`].
    pub fn create(folder: &Path, options: &WriteOptions) -> Result<Self, BagError> {
        let name = folder.file_name().ok_or_else(|| BagError::NoName { path: folder.to_path_buf() })?;
        let file_name = format!("{}_0.mcap", name.to_string_lossy());
        if let Some(parent) = folder.parent() {
            std::fs::create_dir_all(parent).map_err(BagError::io("create", parent))?;
        }
        // Creating and looking in one step: two recorders started at once must not share a folder.
        std::fs::create_dir(folder).map_err(|error| match error.kind() {
            std::io::ErrorKind::AlreadyExists => BagError::AlreadyExists { path: folder.to_path_buf() },
            _ => BagError::io("create", folder)(error),
        })?;
        let path = folder.join(&file_name);
        let file = File::create_new(&path).map_err(BagError::io("create", &path))?;
        let mcap = mcap::WriteOptions::new()
            .profile("ros2")
            .library(concat!("excavator ", env!("CARGO_PKG_VERSION")))
            .compression(options.compression.to_mcap())
            // Threads for compression cost more than they bring at the rates of a machine.
            .compression_threads(0)
            .chunk_size(Some(options.chunk_size))
            // No seeking: whole chunks only reach the file, never one with sizes still to be filled in.
            .disable_seeking(true)
            .create(BufWriter::new(file))
            .map_err(|source| BagError::Write { path, source })?;
        Ok(BagWriter {
            folder: folder.to_path_buf(),
            file_name,
            mcap: Some(mcap),
            topics: Vec::new(),
            span: None,
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
        let metadata = BTreeMap::from([("offered_qos_profiles".to_string(), Qos::list_to_yaml(&topic.qos))]);
        let channel = self.with_mcap(|mcap| {
            let schema = mcap.add_schema(&topic.type_name, "ros2msg", topic.schema.as_bytes())?;
            mcap.add_channel(schema, &topic.name, "cdr", &metadata)
        })?;
        self.topics.push(WrittenTopic { topic: topic.clone(), channel, messages: 0 });
        Ok(TopicId(self.topics.len() - 1))
    }

    /// Writes one message: its bytes with encapsulation, and when it was received and published, ns since the epoch.
    ///
    /// # Errors
    /// [`BagError::Write`] when the file cannot be written, or the id is of another writer.
    pub fn write(&mut self, topic: TopicId, log_time: u64, publish_time: u64, data: &[u8]) -> Result<(), BagError> {
        let Some(written) = self.topics.get_mut(topic.0) else {
            return Err(self.write_error(mcap::McapError::UnknownChannel(0, 0)));
        };
        // The recorder's own count per topic: gaps in it are gaps in the file.
        let sequence = u32::try_from(written.messages & u64::from(u32::MAX)).unwrap_or_default();
        let header = MessageHeader { channel_id: written.channel, sequence, log_time, publish_time };
        written.messages += 1;
        self.with_mcap(|mcap| mcap.write_to_known_channel(&header, data))?;
        let (start, end) = self.span.unwrap_or((log_time, log_time));
        self.span = Some((start.min(log_time), end.max(log_time)));
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
        self.with_mcap(mcap::Writer::flush)
    }

    /// Writes the index and `metadata.yaml`.
    ///
    /// # Errors
    /// [`BagError::Write`], [`BagError::Io`].
    pub fn finish(mut self) -> Result<(), BagError> {
        self.close()
    }

    fn close(&mut self) -> Result<(), BagError> {
        if self.mcap.is_none() {
            return Ok(());
        }
        self.with_mcap(mcap::Writer::finish)?;
        if let Some(mcap) = self.mcap.take() {
            // The library leaves the end of the file in our buffer; on a full disk it is here that writing fails.
            let path = self.folder.join(&self.file_name);
            mcap.into_inner()
                .into_inner()
                .map_err(std::io::IntoInnerError::into_error)
                .and_then(|file| file.sync_all())
                .map_err(BagError::io("write", &path))?;
        }
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
            Contents { file_name: &self.file_name, topics: &topics, span: self.span, custom_data: &self.custom_data };
        let path = self.folder.join(FILE_NAME);
        let text = contents.to_yaml().map_err(|error| BagError::Io {
            action: "write",
            path: path.clone(),
            source: std::io::Error::other(error),
        })?;
        std::fs::write(&path, text).map_err(BagError::io("write", &path))
    }

    /// Does something with the library's writer, which is there as long as the bag is not closed.
    fn with_mcap<T>(
        &mut self,
        action: impl FnOnce(&mut mcap::Writer<BufWriter<File>>) -> mcap::McapResult<T>,
    ) -> Result<T, BagError> {
        let result = match &mut self.mcap {
            Some(mcap) => action(mcap),
            None => Err(mcap::McapError::AttemptedWriteAfterFailure),
        };
        result.map_err(|source| self.write_error(source))
    }

    fn write_error(&self, source: mcap::McapError) -> BagError {
        BagError::Write { path: self.folder.join(&self.file_name), source }
    }
}

impl Drop for BagWriter {
    fn drop(&mut self) {
        // A drop has nobody to tell; finish() is there for those who want to know.
        let _ = self.close();
    }
}
