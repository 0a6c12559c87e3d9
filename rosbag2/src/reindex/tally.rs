//! The contents of a file: messages per topic, times, and a checksum over all bytes, to verify a copy.

use std::sync::Arc;

use super::readable::Readable;
use crate::storage::is_zstd;
use crate::{Error, RawMessage, Topic};

/// Topics and messages that were counted.
#[derive(Debug, Default)]
pub(super) struct Tally {
    /// In order of first appearance, each name once.
    topics: Vec<(Arc<Topic>, u64)>,
    /// Log times of the earliest and the latest message, ns.
    span: Option<(u64, u64)>,
    sum: crc32fast::Hasher,
    /// Messages that are compressed by themselves.
    compressed: u64,
}

impl Tally {
    /// All that can be read of a file.
    pub fn of(source: &mut Readable) -> Result<Tally, Error> {
        let mut tally = Tally::default();
        tally.define(source.file().topics().into_iter());
        while let Some(message) = source.next_message()? {
            tally.count(&message);
        }
        tally.define(source.file().topics().into_iter());
        Ok(tally)
    }

    /// Adds topics, including those without messages.
    pub fn define<'t>(&mut self, topics: impl Iterator<Item = &'t Arc<Topic>>) {
        for topic in topics {
            self.index_of(topic);
        }
    }

    /// Counts a message.
    pub fn count(&mut self, message: &RawMessage) {
        let index = self.index_of(&message.topic);
        self.topics[index].1 += 1;
        let (first, last) = self.span.unwrap_or((message.log_time, message.log_time));
        self.span = Some((first.min(message.log_time), last.max(message.log_time)));
        self.compressed += u64::from(is_zstd(&message.data));
        self.sum.update(message.topic.name.as_bytes());
        self.sum.update(&message.log_time.to_le_bytes());
        self.sum.update(&message.publish_time.to_le_bytes());
        self.sum.update(&message.data);
    }

    fn index_of(&mut self, topic: &Arc<Topic>) -> usize {
        let same = |known: &Arc<Topic>| Arc::ptr_eq(known, topic) || known.name == topic.name;
        match self.topics.iter().position(|(known, _)| same(known)) {
            Some(index) => index,
            None => {
                self.topics.push((Arc::clone(topic), 0));
                self.topics.len() - 1
            }
        }
    }

    /// Adds the tally of another file.
    pub fn add(&mut self, other: &Tally) {
        for (topic, messages) in &other.topics {
            let index = self.index_of(topic);
            self.topics[index].1 += messages;
        }
        self.compressed += other.compressed;
        if let Some((first, last)) = other.span {
            let (begin, end) = self.span.unwrap_or((first, last));
            self.span = Some((begin.min(first), end.max(last)));
        }
    }

    /// Number of messages.
    pub fn messages(&self) -> u64 {
        self.topics.iter().map(|(_, messages)| messages).sum()
    }

    /// Number of messages that are compressed by themselves.
    pub fn compressed(&self) -> u64 {
        self.compressed
    }

    /// Log times of the earliest and the latest message, ns.
    pub fn span(&self) -> Option<(u64, u64)> {
        self.span
    }

    /// Topics with their message counts, sorted by name.
    pub fn topics(&self) -> Vec<(Arc<Topic>, u64)> {
        let mut topics = self.topics.clone();
        topics.sort_by(|a, b| a.0.name.cmp(&b.0.name));
        topics
    }

    /// The values that must be equal in a copy: messages, their bytes and times in order, and the names of topics.
    pub fn fingerprint(&self) -> (u64, u32, Vec<(String, u64)>) {
        let topics = self.topics().into_iter().map(|(topic, messages)| (topic.name.clone(), messages)).collect();
        (self.messages(), self.sum.clone().finalize(), topics)
    }
}
