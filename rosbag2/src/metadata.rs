//! Reads and writes the `metadata.yaml` of a rosbag2 folder.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::limits::ReadLimits;
use crate::qos::QosEntry;
use crate::regular_file::read_regular_text;
use crate::yaml::Yaml;

/// Name of the file in every rosbag2 folder.
pub(crate) const FILE_NAME: &str = "metadata.yaml";

/// The version that rosbag2 of ROS 2 Jazzy writes.
const VERSION_WRITTEN: u32 = 9;

/// What reading needs of a `metadata.yaml` of any version since 1; everything else may be absent or strange.
#[derive(Debug, Deserialize)]
pub(crate) struct Metadata {
    pub storage_identifier: String,
    #[serde(default)]
    pub relative_file_paths: Vec<String>,
    #[serde(default)]
    pub compression_format: Option<String>,
    #[serde(default)]
    pub compression_mode: Option<String>,
    #[serde(default)]
    pub message_count: Option<u64>,
    #[serde(default)]
    pub topics_with_message_count: Vec<TopicWithCount>,
}

#[derive(Debug, Deserialize)]
pub(crate) struct TopicWithCount {
    pub topic_metadata: TopicMetadata,
}

#[derive(Debug, Deserialize)]
pub(crate) struct TopicMetadata {
    pub name: String,
    pub serialization_format: String,
}

#[derive(Deserialize)]
struct Document {
    rosbag2_bagfile_information: Metadata,
}

impl Metadata {
    /// The content of the file at `path`.
    pub fn read(path: &Path, limits: &ReadLimits) -> Result<Metadata, Error> {
        let text = read_regular_text(path, limits.document)?;
        let document: Document = crate::yaml::from_str(&text, limits)
            .map_err(|reason| Error::BadMetadata { path: path.to_path_buf(), reason })?;
        Ok(document.rosbag2_bagfile_information)
    }

    /// The key-value pairs in `custom_data` of the file at `path`; empty if the file does not exist or cannot be read.
    pub fn custom_data(path: &Path, limits: &ReadLimits) -> BTreeMap<String, String> {
        let document: Option<Yaml> =
            read_regular_text(path, limits.document).ok().and_then(|text| crate::yaml::from_str(&text, limits).ok());
        let pairs = document.and_then(|yaml| yaml.get("rosbag2_bagfile_information")?.get("custom_data").cloned());
        let Some(Yaml::Mapping(entries)) = pairs else { return BTreeMap::new() };
        let texts = entries.into_iter().filter_map(|entry| match entry {
            (Yaml::String(key), Yaml::String(value)) => Some((key, value)),
            _ => None,
        });
        texts.collect()
    }
}

/// What is known about a bag when it is closed.
#[derive(Debug, Clone)]
pub(crate) struct Contents<'c> {
    /// `mcap` or `sqlite3`.
    pub storage: &'static str,
    pub files: &'c [FileContents],
    pub topics: &'c [TopicContents],
    pub custom_data: &'c BTreeMap<String, String>,
    pub compression: BagCompression,
}

/// What rosbag2 itself compressed, with zstd. Compressed chunks of MCAP files are not its business.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum BagCompression {
    /// Nothing.
    #[default]
    None,
    /// Every message by itself.
    Message,
    /// Every file as a whole.
    File,
}

impl BagCompression {
    /// The format and the mode in the metadata.
    fn words(self) -> (&'static str, &'static str) {
        match self {
            BagCompression::None => ("", ""),
            BagCompression::Message => ("zstd", "MESSAGE"),
            BagCompression::File => ("zstd", "FILE"),
        }
    }
}

/// One file of [`Contents`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct FileContents {
    pub name: String,
    /// Log times of the earliest and the latest message, ns; `None` without messages.
    pub span: Option<(u64, u64)>,
    pub message_count: u64,
}

/// One topic of [`Contents`].
#[derive(Debug, Clone)]
pub(crate) struct TopicContents {
    pub name: String,
    pub type_name: String,
    pub qos: Vec<QosEntry>,
    pub message_count: u64,
}

impl Contents<'_> {
    /// The text of `metadata.yaml`, field by field in the order of rosbag2.
    pub fn to_yaml(&self) -> Result<String, String> {
        let spans = || self.files.iter().filter_map(|file| file.span);
        let whole = spans().map(|span| span.0).min().zip(spans().map(|span| span.1).max());
        let (starting_time, duration) = start_and_duration(whole);
        let message_count = self.topics.iter().map(|topic| topic.message_count).sum();
        let (compression_format, compression_mode) = self.compression.words();
        crate::yaml::to_string(&Written {
            rosbag2_bagfile_information: WrittenMetadata {
                version: VERSION_WRITTEN,
                storage_identifier: self.storage,
                duration,
                starting_time,
                message_count,
                topics_with_message_count: self.topics.iter().map(WrittenTopic::from).collect(),
                compression_format,
                compression_mode,
                relative_file_paths: self.files.iter().map(|file| file.name.as_str()).collect(),
                files: self.files.iter().map(WrittenFile::from).collect(),
                custom_data: (!self.custom_data.is_empty()).then_some(self.custom_data),
                ros_distro: "jazzy",
            },
        })
    }
}

#[derive(Serialize)]
struct Written<'w> {
    rosbag2_bagfile_information: WrittenMetadata<'w>,
}

#[derive(Serialize)]
struct WrittenMetadata<'w> {
    version: u32,
    storage_identifier: &'static str,
    duration: Duration,
    starting_time: StartingTime,
    message_count: u64,
    topics_with_message_count: Vec<WrittenTopic<'w>>,
    compression_format: &'static str,
    compression_mode: &'static str,
    relative_file_paths: Vec<&'w str>,
    files: Vec<WrittenFile<'w>>,
    custom_data: Option<&'w BTreeMap<String, String>>,
    ros_distro: &'static str,
}

#[derive(Clone, Copy, Serialize)]
struct Duration {
    nanoseconds: u64,
}

#[derive(Clone, Copy, Serialize)]
struct StartingTime {
    nanoseconds_since_epoch: u64,
}

#[derive(Serialize)]
struct WrittenFile<'w> {
    path: &'w str,
    starting_time: StartingTime,
    duration: Duration,
    message_count: u64,
}

impl<'w> From<&'w FileContents> for WrittenFile<'w> {
    fn from(file: &'w FileContents) -> Self {
        let (starting_time, duration) = start_and_duration(file.span);
        WrittenFile { path: &file.name, starting_time, duration, message_count: file.message_count }
    }
}

fn start_and_duration(span: Option<(u64, u64)>) -> (StartingTime, Duration) {
    let (start, end) = span.unwrap_or((0, 0));
    (StartingTime { nanoseconds_since_epoch: start }, Duration { nanoseconds: end - start })
}

#[derive(Serialize)]
struct WrittenTopic<'w> {
    topic_metadata: WrittenTopicMetadata<'w>,
    message_count: u64,
}

#[derive(Serialize)]
struct WrittenTopicMetadata<'w> {
    name: &'w str,
    r#type: &'w str,
    serialization_format: &'static str,
    offered_qos_profiles: &'w [QosEntry],
    type_description_hash: &'static str,
}

impl<'w> From<&'w TopicContents> for WrittenTopic<'w> {
    fn from(topic: &'w TopicContents) -> Self {
        WrittenTopic {
            topic_metadata: WrittenTopicMetadata {
                name: &topic.name,
                r#type: &topic.type_name,
                serialization_format: "cdr",
                offered_qos_profiles: &topic.qos,
                type_description_hash: "",
            },
            message_count: topic.message_count,
        }
    }
}
