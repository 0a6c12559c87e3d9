//! Reads the state and command messages of a bag as one recording.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use excavator_model::recording::Recording;
use excavator_msgs::{ArmState, Message, OrificeCommand};
use rosbag2::cdr::CdrError;
use rosbag2::{Damage, LossReader, RawMessage, RawMessages, Topic};

use super::command_decoder::CommandDecoder;
use super::command_track::CommandTrack;
use super::report::ReadReport;
use super::state_decoder::StateDecoder;
use super::state_table::StateTable;
use super::topic_check;
use crate::{BagError, Topics};

/// Reads the bag at `path` (a rosbag2 folder or a bare `.mcap` file) as a recording.
///
/// The clock consists of the stamps in the headers of the state messages, sorted. Commands are held from their own
/// stamp until the next one. A command topic is not required: without it `orifice_command` is `NaN`. The report
/// contains what was dropped, sorted, damaged or missing.
///
/// # Errors
/// All of [`RawMessages::open`]; [`BagError::NoTopic`] and [`BagError::NoMessages`] for the state topic;
/// [`BagError::WrongType`], [`BagError::OtherDefinition`], [`rosbag2::Error::UnsupportedSerialization`] for either topic;
/// [`BagError::Undecodable`] if no message of a topic can be decoded; [`rosbag2::Error::Limit`] for a bag whose values
/// need more memory than [`ReadLimits`](rosbag2::ReadLimits) allow.
pub fn read_recording(path: &Path, topics: &Topics) -> Result<(Recording, ReadReport), BagError> {
    let mut recording = Recording::default();
    let report = read_recording_in_blocks(path, topics, usize::MAX, |whole| {
        recording = whole;
        ControlFlow::Continue(())
    })?;
    Ok((recording, report))
}

/// As [`read_recording`], but passes blocks of `samples` state messages to `take` as they are read: for recordings that
/// do not fit into memory. `take` can stop the reading. Messages are sorted by stamp within a block; the first samples
/// of a block can be older than the last ones of the previous block.
///
/// # Errors
/// As [`read_recording`]; `take` may already have received blocks.
pub fn read_recording_in_blocks(
    path: &Path,
    topics: &Topics,
    samples: usize,
    mut take: impl FnMut(Recording) -> ControlFlow<()>,
) -> Result<ReadReport, BagError> {
    let mut messages = RawMessages::open(path)?;
    let mut report = ReadReport::default();
    report.sources.extend([&topics.state, &topics.command].map(|topic| (topic.clone(), Vec::new())));
    let mut states = TopicReader::<ArmState>::new(path, &topics.state);
    let mut commands = TopicReader::<OrificeCommand>::new(path, &topics.command);
    let (mut state_decoder, mut command_decoder) = (StateDecoder::new(), CommandDecoder::default());
    let mut table = StateTable::default();
    let mut track = CommandTrack::default();
    let mut counts = TopicCounts::of(path);
    let mut first_log_time = None;
    let mut blocks = BlockMaker { source: path.display().to_string(), start: None };
    while let Some(message) = messages.next() {
        let message = message?;
        first_log_time.get_or_insert(message.log_time);
        counts.count(&message);
        if states.is_of(&message) {
            let numbers = state_decoder.numbers(&message.data).filter(|_| states.is_checked(&message));
            messages.check_memory(table.memory_with(0))?;
            if numbers.is_some_and(|numbers| table.push_numbers(numbers)) {
                states.seen += 1;
            } else if let Some(state) = states.decode(&message, |bytes| state_decoder.decode(bytes))? {
                messages.check_memory(table.memory_with(state.cylinders.len()))?;
                table.push(state);
            }
            if table.len() >= samples.max(1) {
                let block = blocks.make(std::mem::take(&mut table), &mut track, &mut report);
                if take(block).is_break() {
                    return Ok(report);
                }
            }
        } else if commands.is_of(&message) {
            let numbers = command_decoder.numbers(&message.data).filter(|_| commands.is_checked(&message));
            if numbers.is_some_and(|numbers| track.push_numbers(numbers)) {
                commands.seen += 1;
            } else if let Some(command) = commands.decode(&message, |bytes| command_decoder.decode(bytes))? {
                track.push(&command);
            }
        }
    }
    counts.write_to(&mut report);
    report.damage = messages.damage();
    report.truncated_after = truncated_after(&report.damage, first_log_time);
    let found: u64 = report.messages.values().sum();
    report.missing_messages = messages.promised_messages().unwrap_or(0).saturating_sub(found);
    states.finish(&mut report)?;
    commands.finish(&mut report)?;
    if !table.is_empty() {
        let _ = take(blocks.make(table, &mut track, &mut report));
    } else if blocks.start.is_none() {
        return Err(no_state(&messages, topics, &report));
    }
    Ok(report)
}

/// Converts tables to recordings, and adds up their reports.
struct BlockMaker {
    source: String,
    /// Stamp of the first sample of the first block, ns.
    start: Option<i64>,
}

impl BlockMaker {
    fn make(&mut self, table: StateTable, track: &mut CommandTrack, report: &mut ReadReport) -> Recording {
        let mut own = ReadReport::default();
        let (mut recording, stamps) = table.into_recording(&self.source, &mut own);
        let next = track.continued();
        std::mem::replace(track, next).hold(&mut recording, &stamps, &mut own);
        let start = *self.start.get_or_insert(recording.start_nanoseconds);
        let offset = (recording.start_nanoseconds - start) as f64 * 1e-9;
        own.gaps.iter_mut().for_each(|gap| gap.after += offset);
        report.add_block(own);
        recording
    }
}

fn no_state(messages: &RawMessages, topics: &Topics, report: &ReadReport) -> BagError {
    let path = messages.path().to_path_buf();
    let topic = topics.state.clone();
    let existing: Vec<String> = messages.topics().iter().map(|topic| topic.name.clone()).collect();
    // If there is damage, the definition of the topic itself may be lost.
    if existing.contains(&topic) || (existing.is_empty() && !report.damage.is_empty()) {
        let damage = report.damage.iter().map(ToString::to_string).collect();
        BagError::NoMessages { path, topic, damage }
    } else {
        BagError::NoTopic { path, topic, existing }
    }
}

/// Time from the first message of the bag to the last one before the first missing end of a file, s.
pub(crate) fn truncated_after(damage: &[Damage], first_log_time: Option<u64>) -> Option<f64> {
    let cut = damage.iter().find(|damage| damage.is_truncation())?;
    let nanoseconds = cut.readable_until.zip(first_log_time).map_or(0, |(until, first)| until.saturating_sub(first));
    Some(nanoseconds as f64 / 1e9)
}

/// Messages per topic. Counted per shared [`Topic`] first, since a lookup by name for every message costs more than
/// decompressing it.
pub(crate) struct TopicCounts {
    topics: Vec<TopicCount>,
    losses: LossReader,
}

struct TopicCount {
    topic: Arc<Topic>,
    messages: u64,
    /// Whether its messages tell of losses.
    tells: bool,
}

impl TopicCounts {
    /// For a bag.
    pub fn of(bag: &Path) -> TopicCounts {
        TopicCounts { topics: Vec::new(), losses: LossReader::of(bag) }
    }

    /// Counts one message, and reads it if it tells of lost ones.
    pub fn count(&mut self, message: &RawMessage) {
        let tells = match self.topics.iter_mut().find(|one| Arc::ptr_eq(&one.topic, &message.topic)) {
            Some(one) => {
                one.messages += 1;
                one.tells
            }
            None => {
                let (topic, tells) = (Arc::clone(&message.topic), LossReader::is_told_by(&message.topic));
                self.topics.push(TopicCount { topic, messages: 1, tells });
                tells
            }
        };
        if tells {
            self.losses.take(message);
        }
    }

    /// Adds the counts and the losses to the report.
    pub fn write_to(self, report: &mut ReadReport) {
        for TopicCount { topic, messages, .. } in self.topics {
            *report.messages.entry(topic.name.clone()).or_default() += messages;
        }
        report.lost = self.losses.finish();
    }
}

/// Decodes the messages of one topic, after checking each of its definitions in the bag.
struct TopicReader<'r, M> {
    path: &'r Path,
    topic: &'r str,
    checked: Option<Arc<Topic>>,
    seen: u64,
    undecodable: u64,
    first_undecodable: Option<BagError>,
    message: std::marker::PhantomData<M>,
}

impl<'r, M: Message> TopicReader<'r, M> {
    fn new(path: &'r Path, topic: &'r str) -> Self {
        TopicReader {
            path,
            topic,
            checked: None,
            seen: 0,
            undecodable: 0,
            first_undecodable: None,
            message: std::marker::PhantomData,
        }
    }

    /// Whether the message is on the topic.
    fn is_of(&self, message: &RawMessage) -> bool {
        self.is_checked(message) || message.topic.name == self.topic
    }

    /// Whether it has the definition that was checked last.
    fn is_checked(&self, message: &RawMessage) -> bool {
        self.checked.as_ref().is_some_and(|checked| Arc::ptr_eq(checked, &message.topic))
    }

    /// The message; `None` if its bytes cannot be decoded.
    fn decode<T>(
        &mut self,
        message: &RawMessage,
        decode: impl FnOnce(&[u8]) -> Result<T, CdrError>,
    ) -> Result<Option<T>, BagError> {
        if !self.is_checked(message) {
            topic_check::check::<M>(self.path, &message.topic)?;
            self.checked = Some(Arc::clone(&message.topic));
        }
        let index = self.seen;
        self.seen += 1;
        match decode(&message.data) {
            Ok(decoded) => Ok(Some(decoded)),
            Err(error) => {
                self.undecodable += 1;
                self.first_undecodable.get_or_insert_with(|| BagError::Undecodable {
                    path: self.path.to_path_buf(),
                    topic: self.topic.to_string(),
                    index,
                    bytes: message.data.len(),
                    reason: error.to_string(),
                });
                Ok(None)
            }
        }
    }

    /// Adds what could not be decoded to the report. If no message could be decoded, it is an error: the type is wrong.
    fn finish(self, report: &mut ReadReport) -> Result<(), BagError> {
        let Some(error) = self.first_undecodable else {
            return Ok(());
        };
        if self.undecodable == self.seen {
            return Err(error);
        }
        report.undecodable += self.undecodable;
        report.first_undecodable.get_or_insert_with(|| error.to_string());
        Ok(())
    }
}
