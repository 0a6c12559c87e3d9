//! Mapped topics of a bag as tracks.

use std::path::Path;
use std::sync::Arc;

use excavator_model::recording::Recording;

use super::assemble::{Samples, assemble};
use super::conversion::Conversion;
use super::document::{SignalSource, Stamp, TopicMap};
use super::error::MapError;
use crate::cdr::CdrError;
use crate::dynamic::{Definitions, FieldPath, Kind, Layout, Selector};
use crate::reading::{ReadReport, TopicCounts, truncated_after};
use crate::{BagError, RawMessage, RawMessages, Topic};

/// Reads the signals of a map from a bag.
pub(super) fn read_bag(path: &Path, map: &TopicMap) -> Result<(Recording, ReadReport), BagError> {
    let mut extra = Definitions::default();
    for file in &map.definitions {
        extra.add_file(file)?;
    }
    let mut topics = mapped_topics(path, map)?;
    let mut messages = RawMessages::open(path)?;
    let (mut counts, mut report) = (TopicCounts::default(), ReadReport::default());
    let mut first_log_time = None;
    let mut memory = 0;
    while let Some(message) = messages.next() {
        let message = message?;
        first_log_time.get_or_insert(message.log_time);
        counts.count(&message);
        if let Some(topic) = topics.iter_mut().find(|topic| topic.name == message.topic.name) {
            topic.take(path, &message, &extra)?;
            memory += (size_of::<i64>() + topic.signals.len() * size_of::<(i64, f64)>()) as u64;
            messages.check_memory(memory)?;
        }
    }
    counts.write_to(&mut report);
    report.damage = messages.damage();
    report.truncated_after = truncated_after(&report.damage, first_log_time);
    let found: u64 = report.messages.values().sum();
    report.missing_messages = messages.promised_messages().unwrap_or(0).saturating_sub(found);
    for topic in &mut topics {
        topic.finish(&messages, &mut report)?;
    }
    let (clock_name, stamps) = clock(map, &mut topics);
    let mut signals: Vec<(&SignalSource, Samples)> = constants(map)?;
    signals.extend(topics.into_iter().flat_map(|topic| topic.signals).map(|s| (s.source, Samples::Timed(s.samples))));
    in_order_of_map(map, &mut signals);
    let recording = assemble(path, &clock_name, stamps, signals, &mut report)?;
    Ok((recording, report))
}

/// Signals of which the map itself gives the value.
pub(super) fn constants(map: &TopicMap) -> Result<Vec<(&SignalSource, Samples)>, MapError> {
    let mut constants = Vec::new();
    for source in &map.signals {
        if let Some(value) = &source.value {
            let value = value.to_si(&source.signal.to_string(), "value", source.signal.kind.dimension())?;
            constants.push((source, Samples::Constant(value)));
        }
    }
    Ok(constants)
}

/// Sorts signals as the map lists them, so that cylinders come in its order.
pub(super) fn in_order_of_map(map: &TopicMap, signals: &mut [(&SignalSource, Samples)]) {
    signals.sort_by_key(|(source, _)| map.signals.iter().position(|other| other.signal == source.signal));
}

fn mapped_topics<'m>(path: &Path, map: &'m TopicMap) -> Result<Vec<MappedTopic<'m>>, BagError> {
    let mut topics: Vec<MappedTopic> = Vec::new();
    for source in map.signals.iter().filter(|source| source.value.is_none()) {
        let (Some(name), Some(field)) = (&source.topic, &source.field) else {
            let signal = source.signal.to_string();
            return Err(
                MapError::WrongSource { signal, found: "column", path: path.to_path_buf(), wanted: "bag" }.into()
            );
        };
        let topic = topic_of(&mut topics, name);
        topic.signals.push(MappedSignal {
            source,
            field,
            conversion: Conversion::of(source, None)?,
            stamp: StampReader::default(),
            selector: None,
            samples: Vec::new(),
        });
    }
    if let Some(name) = &map.clock.topic {
        topic_of(&mut topics, name);
    }
    for topic in &mut topics {
        topic.clock_stamp = StampReader { policy: map.clock.stamp.clone(), selector: None };
    }
    Ok(topics)
}

fn topic_of<'t, 'm>(topics: &'t mut Vec<MappedTopic<'m>>, name: &'m str) -> &'t mut MappedTopic<'m> {
    let index = match topics.iter().position(|topic| topic.name == name) {
        Some(index) => index,
        None => {
            topics.push(MappedTopic { name, ..MappedTopic::default() });
            topics.len() - 1
        }
    };
    &mut topics[index]
}

/// The stamps of the clock's topic: that of the map, else the one with most messages.
fn clock(map: &TopicMap, topics: &mut [MappedTopic]) -> (String, Vec<i64>) {
    let mut best: Option<&mut MappedTopic> = None;
    for topic in topics {
        let better = match (&map.clock.topic, &best) {
            (Some(wanted), _) => topic.name == wanted,
            (None, Some(best)) => topic.stamps.len() > best.stamps.len(),
            (None, None) => true,
        };
        if better {
            best = Some(topic);
        }
    }
    best.map(|topic| (topic.name.to_string(), std::mem::take(&mut topic.stamps))).unwrap_or_default()
}

/// One topic from which signals are taken.
#[derive(Default)]
struct MappedTopic<'m> {
    name: &'m str,
    signals: Vec<MappedSignal<'m>>,
    clock_stamp: StampReader,
    stamps: Vec<i64>,
    /// The definition that the selectors were made for, with its layout.
    layout: Option<(Arc<Topic>, Layout)>,
    seen: u64,
    undecodable: u64,
    first_undecodable: Option<BagError>,
}

struct MappedSignal<'m> {
    source: &'m SignalSource,
    field: &'m FieldPath,
    conversion: Conversion,
    stamp: StampReader,
    selector: Option<Selector>,
    samples: Vec<(i64, f64)>,
}

impl MappedTopic<'_> {
    fn take(&mut self, path: &Path, message: &RawMessage, extra: &Definitions) -> Result<(), BagError> {
        if !self.layout.as_ref().is_some_and(|(topic, _)| Arc::ptr_eq(topic, &message.topic)) {
            self.prepare(path, &message.topic, extra)?;
        }
        let index = self.seen;
        self.seen += 1;
        if let Err(error) = self.read(message) {
            self.undecodable += 1;
            self.first_undecodable.get_or_insert_with(|| BagError::Undecodable {
                path: path.to_path_buf(),
                topic: self.name.to_string(),
                index,
                bytes: message.data.len(),
                reason: error.to_string(),
            });
        }
        Ok(())
    }

    /// Looks every field up in the definition that this file has of the topic.
    fn prepare(&mut self, path: &Path, topic: &Arc<Topic>, extra: &Definitions) -> Result<(), BagError> {
        if topic.message_encoding != "cdr" {
            let (path, format) = (path.to_path_buf(), topic.message_encoding.clone());
            return Err(BagError::UnsupportedSerialization { path, topic: self.name.to_string(), format });
        }
        let layout = Layout::of_topic(topic, extra)
            .map_err(|source| MapError::Layout { topic: self.name.to_string(), source })?;
        for signal in &mut self.signals {
            let name = signal.source.signal.to_string();
            let wrong = |source| MapError::Field { signal: name.clone(), topic: topic.name.clone(), source };
            signal.selector = Some(Selector::number(&layout, signal.field).map_err(wrong)?);
            signal.stamp = StampReader { policy: signal.source.stamp.clone(), selector: None };
            signal.stamp.prepare(&layout).map_err(wrong)?;
        }
        self.clock_stamp.prepare(&layout).map_err(|source| MapError::Field {
            signal: "[clock]".to_string(),
            topic: topic.name.clone(),
            source,
        })?;
        self.layout = Some((Arc::clone(topic), layout));
        Ok(())
    }

    /// Takes nothing from a message that does not fit its definition from beginning to end.
    fn read(&mut self, message: &RawMessage) -> Result<(), CdrError> {
        let Some((_, layout)) = &self.layout else {
            return Ok(());
        };
        layout.check(&message.data)?;
        self.stamps.push(self.clock_stamp.read(layout, message)?);
        for signal in &mut self.signals {
            let Some(selector) = &signal.selector else { continue };
            if let Some(number) = selector.read(layout, &message.data)? {
                let shift = (signal.source.time_shift.unwrap_or(0.0) * 1e9).round() as i64;
                let stamp = signal.stamp.read(layout, message)?.saturating_add(shift);
                signal.samples.push((stamp, signal.conversion.apply(number)));
            }
        }
        Ok(())
    }

    /// Enters what could not be decoded into the report; a topic without any readable message is an error.
    fn finish(&mut self, messages: &RawMessages, report: &mut ReadReport) -> Result<(), BagError> {
        if self.seen == 0 {
            let (path, topic) = (messages.path().to_path_buf(), self.name.to_string());
            let existing: Vec<String> = messages.topics().iter().map(|topic| topic.name.clone()).collect();
            return Err(if existing.contains(&topic) {
                let damage = report.damage.iter().map(ToString::to_string).collect();
                BagError::NoMessages { path, topic, damage }
            } else {
                BagError::NoTopic { path, topic, existing }
            });
        }
        if let Some(error) = self.first_undecodable.take() {
            if self.undecodable == self.seen {
                return Err(error);
            }
            report.undecodable += self.undecodable;
            report.first_undecodable.get_or_insert_with(|| error.to_string());
        }
        Ok(())
    }
}

/// Which time a message has.
#[derive(Debug, Clone, Default)]
struct StampReader {
    policy: Stamp,
    selector: Option<Selector>,
}

impl StampReader {
    fn prepare(&mut self, layout: &Layout) -> Result<(), crate::dynamic::PathError> {
        self.selector = match &self.policy {
            Stamp::Log => None,
            Stamp::Auto if !has_header(layout) => None,
            Stamp::Auto | Stamp::Header => Some(Selector::time(layout, &"header.stamp".parse()?)?),
            Stamp::Field(path) => Some(Selector::time(layout, &path.parse()?)?),
        };
        Ok(())
    }

    fn read(&self, layout: &Layout, message: &RawMessage) -> Result<i64, CdrError> {
        let log_time = i64::try_from(message.log_time).unwrap_or(i64::MAX);
        let Some(selector) = &self.selector else {
            return Ok(log_time);
        };
        let stamp = selector.read_time(layout, &message.data)?;
        let unset = self.policy == Stamp::Auto && stamp == Some(0);
        Ok(stamp.filter(|_| !unset).unwrap_or(log_time))
    }
}

fn has_header(layout: &Layout) -> bool {
    let members = layout.structure(0).map_or(&[][..], |structure| &structure.members);
    members.iter().any(|member| {
        member.name == "header"
            && matches!(member.kind, Kind::Struct(number)
                if layout.structure(number).is_some_and(|structure| structure.name == "std_msgs/Header"))
    })
}
