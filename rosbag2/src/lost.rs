//! Messages that were lost while a bag was recorded, as its recorder tells.
//!
//! A recorder tells it in events (`rosbag2_interfaces/msg/MessagesLostEvent`), in its log, which `/rosout` carries, or in the
//! custom data of `metadata.yaml`. Two of these may count the same loss, so the larger count of a topic is taken.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::metadata::{FILE_NAME, Metadata};
use crate::{RawMessage, ReadLimits, Topic, cdr};

/// Type of the events.
const EVENT: &str = "MessagesLostEvent";
/// Type of the messages on `/rosout`.
const LOG: &str = "rcl_interfaces/msg/Log";
/// Key of the custom data that `excavator record` writes, before the name of the topic.
pub(crate) const CUSTOM_KEY: &str = "lost_messages:";
/// Maximum number of topics with losses that are kept.
const MOST_TOPICS: usize = 1000;

/// Messages of one topic that a bag lacks.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct LostMessages {
    /// The topic; empty where the recorder does not say which.
    pub topic: String,
    /// Messages that did not reach the recorder.
    pub in_transport: u64,
    /// Messages that reached the recorder and were not written.
    pub in_recorder: u64,
    /// Log times of the first and the last message that tells of it, ns since the epoch; the loss was before. `None` for
    /// losses of which only the metadata tells.
    pub told: Option<(u64, u64)>,
}

impl LostMessages {
    /// All of them.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.in_transport.saturating_add(self.in_recorder)
    }

    /// How many of how many, and where, in one line. `read` is the number of messages of the topic that the bag has.
    #[must_use]
    pub fn text(&self, read: Option<u64>) -> String {
        let LostMessages { topic, in_transport, in_recorder, .. } = self;
        let of = match read {
            _ if topic.is_empty() => "messages of unknown topics".to_string(),
            Some(read) => format!("of {} messages of {topic}", read.saturating_add(self.count())),
            None => format!("messages of {topic}"),
        };
        let place = match (in_transport, in_recorder) {
            (_, 0) => "on their way to the recorder".to_string(),
            (0, _) => "in the recorder".to_string(),
            _ => format!("{in_transport} on their way to the recorder and {in_recorder} in it"),
        };
        format!("{} {of} were lost while the bag was recorded: {place}", self.count())
    }
}

/// Collects what messages tell about losses.
#[derive(Debug, Default)]
pub struct LossReader {
    topics: BTreeMap<String, Counts>,
}

/// Counts of one topic: transport and recorder.
#[derive(Debug, Default)]
struct Counts {
    /// Events tell what was lost since the last event.
    of_events: [u64; 2],
    /// Logs and metadata tell all that was lost so far.
    so_far: [u64; 2],
    told: Option<(u64, u64)>,
}

#[derive(Deserialize)]
struct LostEvent {
    #[serde(rename = "node_name")]
    _node_name: String,
    messages_lost_statistics: Vec<TopicLosses>,
}

#[derive(Deserialize)]
struct TopicLosses {
    topic_name: String,
    messages_lost_in_transport: u64,
    messages_lost_in_recorder: u64,
}

#[derive(Deserialize)]
struct Log {
    _stamp: (i32, u32),
    _level: u8,
    _name: String,
    msg: String,
    _file: String,
    _function: String,
    _line: u32,
}

impl LossReader {
    /// For a bag, with what its metadata tells.
    #[must_use]
    pub fn of(bag: &Path) -> LossReader {
        let mut reader = LossReader::default();
        for (key, value) in Metadata::custom_data(&bag.join(FILE_NAME), &ReadLimits::DEFAULT) {
            if let (Some(topic), Ok(lost)) = (key.strip_prefix(CUSTOM_KEY), value.parse::<u64>())
                && lost > 0
            {
                reader.so_far(topic, [lost, 0], None);
            }
        }
        reader
    }

    /// Whether messages of this topic may tell about losses.
    #[must_use]
    pub fn is_told_by(topic: &Topic) -> bool {
        topic.type_name == LOG || topic.type_name.rsplit('/').next() == Some(EVENT)
    }

    /// Reads one message of such a topic; any other content is ignored.
    pub fn take(&mut self, message: &RawMessage) {
        let now = message.log_time;
        if message.topic.type_name != LOG {
            let Ok(event) = cdr::decode::<LostEvent>(&message.data) else { return };
            for TopicLosses { topic_name, messages_lost_in_transport, messages_lost_in_recorder } in
                event.messages_lost_statistics
            {
                let Some(counts) = self.counts(&topic_name, Some(now)) else { continue };
                let own = [messages_lost_in_transport, messages_lost_in_recorder];
                counts.of_events.iter_mut().zip(own).for_each(|(sum, lost)| *sum = sum.saturating_add(lost));
            }
        } else if let Ok(log) = cdr::decode::<Log>(&message.data) {
            self.read_log(&log.msg, now);
        }
    }

    /// What is known, by topic; a count without topic only where no topic has one.
    #[must_use]
    pub fn finish(self) -> Vec<LostMessages> {
        let all = self.topics.into_iter().map(|(topic, counts)| {
            let [in_transport, in_recorder] = [0, 1].map(|layer| counts.of_events[layer].max(counts.so_far[layer]));
            LostMessages { topic, in_transport, in_recorder, told: counts.told }
        });
        let mut lost: Vec<LostMessages> = all.filter(|lost| lost.count() > 0).collect();
        if lost.iter().any(|lost| !lost.topic.is_empty()) {
            lost.retain(|lost| !lost.topic.is_empty());
        }
        lost
    }

    fn read_log(&mut self, text: &str, now: u64) {
        let number = |text: &str| text.trim().trim_end_matches('.').parse::<u64>().ok();
        if let Some((_, rest)) = text.split_once("Cache buffers lost messages per topic:") {
            for line in rest.lines() {
                if let Some((topic, lost)) = line.trim().rsplit_once(':')
                    && topic.starts_with('/')
                    && let Some(lost) = number(lost)
                {
                    self.so_far(topic, [0, lost], Some(now));
                }
            }
        } else if let Some((_, rest)) = text.split_once("lost on transport layer for topic '") {
            if let Some((topic, rest)) = rest.split_once('\'')
                && let Some(lost) = rest.split_once("Total lost:").and_then(|(_, lost)| number(lost))
            {
                self.so_far(topic, [lost, 0], Some(now));
            }
        } else if let Some((_, lost)) = text.split_once("Number of messages lost on the transport layer:") {
            self.so_far("", [number(lost).unwrap_or(0), 0], Some(now));
        } else if let Some((_, lost)) = text.split_once("Number of messages lost in the recorder:") {
            self.so_far("", [0, number(lost).unwrap_or(0)], Some(now));
        }
    }

    fn so_far(&mut self, topic: &str, lost: [u64; 2], now: Option<u64>) {
        if let Some(counts) = self.counts(topic, now) {
            counts.so_far.iter_mut().zip(lost).for_each(|(most, lost)| *most = (*most).max(lost));
        }
    }

    fn counts(&mut self, topic: &str, now: Option<u64>) -> Option<&mut Counts> {
        if self.topics.len() >= MOST_TOPICS && !self.topics.contains_key(topic) {
            return None;
        }
        let counts = self.topics.entry(topic.to_string()).or_default();
        if let Some(now) = now {
            let (first, last) = counts.told.unwrap_or((now, now));
            counts.told = Some((first.min(now), last.max(now)));
        }
        Some(counts)
    }
}

#[cfg(test)]
#[allow(clippy::panic, clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::sync::Arc;

    fn message(type_name: &str, log_time: u64, content: Vec<u8>) -> RawMessage {
        let topic = Topic {
            name: "/events".into(),
            type_name: type_name.into(),
            schema_encoding: String::new(),
            schema: String::new(),
            message_encoding: "cdr".into(),
            offered_qos_profiles: String::new(),
        };
        assert!(LossReader::is_told_by(&topic));
        RawMessage { topic: Arc::new(topic), sequence: 0, log_time, publish_time: log_time, data: content.into() }
    }

    fn log(text: &str) -> Vec<u8> {
        cdr::encode(&((0_i32, 0_u32), 30_u8, "rosbag2_recorder", text, "f.cpp", "f", 7_u32)).unwrap()
    }

    #[test]
    fn events_are_added_up_and_logs_tell_the_sum_so_far() {
        let event = |topic: &str, transport: u64, recorder: u64| {
            cdr::encode(&("/recorder", vec![(topic, transport, recorder)])).unwrap()
        };
        let mut reader = LossReader::default();
        let type_name = "rosbag2_interfaces/msg/MessagesLostEvent";
        for (now, content) in [(5, event("/a", 3, 0)), (9, event("/a", 4, 1)), (7, event("/b", 0, 2))] {
            reader.take(&message(type_name, now, content));
        }
        reader.take(&message(type_name, 9, vec![0, 1, 0, 0, 9, 9]));
        let text = "Cache buffers lost messages per topic: \n\t/a: 2\n\t/c: 6\nTotal lost: 8";
        reader.take(&message(LOG, 20, log(text)));
        reader.take(&message(LOG, 30, log(text)));
        reader.take(&message(LOG, 31, log("Messages lost on transport layer for topic '/d'. Total lost: 11")));
        reader.take(&message(LOG, 32, log("Number of messages lost on the transport layer: 99")));
        let lost = |topic: &str, in_transport, in_recorder, told| LostMessages {
            topic: topic.into(),
            in_transport,
            in_recorder,
            told: Some(told),
        };
        let expected = [
            lost("/a", 7, 2, (5, 30)),
            lost("/b", 0, 2, (7, 7)),
            lost("/c", 0, 6, (20, 30)),
            lost("/d", 11, 0, (31, 31)),
        ];
        assert_eq!(reader.finish(), expected);
    }

    #[test]
    fn a_count_without_topic_is_kept_where_there_is_no_other() {
        let mut reader = LossReader::default();
        reader.take(&message(LOG, 3, log("Number of messages lost in the recorder: 5")));
        reader.take(&message(LOG, 4, log("a node that has lost its way: 77")));
        let [lost] = &reader.finish()[..] else { panic!("one") };
        assert_eq!((lost.topic.as_str(), lost.in_recorder, lost.count()), ("", 5, 5));
        assert!(LossReader::default().finish().is_empty());
    }
}
