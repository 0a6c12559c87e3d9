//! Summarizes the contents of a bag per topic.

mod clock;
mod spread;
mod timing;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::dynamic::Definitions;
use crate::location::BagFiles;
use crate::lost::{LossReader, LostMessages};
use crate::{Error, RawMessages};

use timing::Times;
pub use timing::{StampTiming, Timing};

/// Contents of a bag. Times are log times: when the recorder received the messages.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BagInfo {
    /// The path that was asked for.
    pub path: PathBuf,
    /// The files in reading order.
    pub files: Vec<PathBuf>,
    /// Size of these files, bytes.
    pub size: u64,
    /// Earliest log time, ns since the epoch; `None` without messages.
    pub start: Option<u64>,
    /// Latest log time, ns since the epoch; `None` without messages.
    pub end: Option<u64>,
    /// Time from the earliest to the latest message, s; 0 without messages.
    pub duration: f64,
    /// Messages of all topics.
    pub message_count: u64,
    /// The topics, by name.
    pub topics: Vec<TopicInfo>,
    /// Messages that were lost while the bag was recorded, as far as its recorder tells.
    pub lost: Vec<LostMessages>,
    /// What is wrong with the bag, one line each.
    pub problems: Vec<String>,
}

/// Contents of one topic.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TopicInfo {
    /// Name: `/arm/state`.
    pub name: String,
    /// Type of the messages; empty when the bag does not say.
    pub type_name: String,
    /// Serialization of the messages: `cdr`.
    pub message_encoding: String,
    /// Messages that can be read.
    pub message_count: u64,
    /// Earliest log time, ns since the epoch; `None` without messages.
    pub first: Option<u64>,
    /// Latest log time, ns since the epoch; `None` without messages.
    pub last: Option<u64>,
    /// How regular the topic is; `None` for fewer than two messages.
    pub timing: Option<Timing>,
}

impl TopicInfo {
    /// Mean number of messages per second, Hz; `None` for fewer than two messages or all at one time.
    #[must_use]
    pub fn mean_rate(&self) -> Option<f64> {
        let nanoseconds = self.last?.checked_sub(self.first?).filter(|&nanoseconds| nanoseconds > 0)?;
        let intervals = self.message_count.checked_sub(1)?;
        Some(intervals as f64 / (nanoseconds as f64 / 1e9))
    }

    fn note(&mut self, log_time: u64) {
        self.message_count += 1;
        self.first = Some(self.first.map_or(log_time, |first| first.min(log_time)));
        self.last = Some(self.last.map_or(log_time, |last| last.max(log_time)));
    }
}

/// Reads the whole bag at `path` and summarizes its contents. Nothing is taken from indexes or `metadata.yaml`. If the
/// metadata declares more than was read, that is a problem.
///
/// # Errors
/// All of [`RawMessages::open`].
pub fn info(path: &Path) -> Result<BagInfo, Error> {
    info_with(path, &Definitions::default())
}

/// As [`info`], with definitions of types that the bag may lack: without a definition, the stamps of a topic are not
/// read.
///
/// # Errors
/// As [`info`].
pub fn info_with(path: &Path, extra: &Definitions) -> Result<BagInfo, Error> {
    let files = BagFiles::locate(path, &crate::ReadLimits::DEFAULT)?.files;
    let mut size = 0;
    for file in &files {
        size += std::fs::metadata(file).map_err(Error::io("read", file))?.len();
    }
    let mut messages = RawMessages::open(path)?;
    let mut losses = LossReader::of(path);
    let mut seen: BTreeMap<String, (TopicInfo, Times)> = BTreeMap::new();
    for message in &mut messages {
        let message = message?;
        let (topic, times) = match seen.get_mut(&message.topic.name) {
            Some(seen) => seen,
            None => seen
                .entry(message.topic.name.clone())
                .or_insert_with(|| (TopicInfo::empty(&message.topic), Times::of(&message.topic, extra))),
        };
        if LossReader::is_told_by(&message.topic) {
            losses.take(&message);
        }
        topic.note(message.log_time);
        times.note(&message);
    }
    let mut topics: BTreeMap<String, TopicInfo> =
        seen.into_iter().map(|(name, (topic, times))| (name, TopicInfo { timing: times.timing(), ..topic })).collect();
    for topic in messages.topics() {
        topics.entry(topic.name.clone()).or_insert_with(|| TopicInfo::empty(&topic));
    }
    let topics: Vec<TopicInfo> = topics.into_values().collect();
    let message_count = topics.iter().map(|topic| topic.message_count).sum();
    let start = topics.iter().filter_map(|topic| topic.first).min();
    let end = topics.iter().filter_map(|topic| topic.last).max();
    let nanoseconds = start.zip(end).map_or(0, |(start, end)| end - start);
    let mut problems: Vec<String> = messages.damage().iter().map(ToString::to_string).collect();
    if let Some(promised) = messages.promised_messages().filter(|&promised| promised != message_count) {
        problems.push(format!("metadata.yaml promises {promised} messages, {message_count} were found"));
    }
    Ok(BagInfo {
        path: path.to_path_buf(),
        files,
        size,
        start,
        end,
        duration: nanoseconds as f64 / 1e9,
        message_count,
        topics,
        lost: losses.finish(),
        problems,
    })
}

impl TopicInfo {
    fn empty(topic: &crate::Topic) -> TopicInfo {
        TopicInfo {
            name: topic.name.clone(),
            type_name: topic.type_name.clone(),
            message_encoding: topic.message_encoding.clone(),
            message_count: 0,
            first: None,
            last: None,
            timing: None,
        }
    }
}
