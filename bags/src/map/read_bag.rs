//! Reads the mapped topics of a bag as tracks.

use std::path::Path;

use excavator_model::recording::Recording;
use rosbag2::dynamic::Definitions;

use super::assemble::{Input, assemble, constants};
use super::channels::Beside;
use super::document::TopicMap;
use super::error::MapError;
use super::joined::{self, Span};
use super::mapped_topic::MappedTopic;
use super::message_times::Auto;
use super::messages::Messages;
use super::one_clock::{two_publishers, warnings, why_by_log_times};
use super::table_clock::{Dating, EPOCH_SECONDS};
use super::wanted::{Wanted, wanted};
use crate::can::Database;
use crate::reading::{ReadReport, TopicCounts, truncated_after};
use crate::{BagError, own_definitions};

/// Reads the signals of a map from a bag. Also returns whether its stamps are absolute times.
pub(super) fn read_bag(path: &Path, map: &TopicMap) -> Result<(Recording, ReadReport, Dating), BagError> {
    let mut extra = own_definitions().clone();
    for file in &map.definitions {
        extra.add_file(file)?;
    }
    let joined = joined::read(path, map)?;
    let (wanted, computed) = wanted(map, &joined::headings(None, &joined))?;
    let (columns, fields): (Vec<Wanted>, Vec<Wanted>) =
        wanted.into_iter().partition(|wanted| wanted.from.column.is_some());
    if let Some(column) = columns.first().filter(|_| map.join.is_empty()) {
        let (signal, path) = (column.label.clone(), path.to_path_buf());
        return Err(MapError::WrongSource { signal, found: "column", path, wanted: "bag" }.into());
    }
    let (topics, mut report) = read_topics(path, map, &fields, &extra)?;
    let (clock_name, stamps) = clock(map, &topics);
    let (Some(&first), Some(&last)) = (stamps.iter().min(), stamps.iter().max()) else {
        return Err(MapError::EmptyClock { path: path.to_path_buf(), clock: clock_name }.into());
    };
    let dating = if first as f64 / 1e9 > EPOCH_SECONDS { Dating::Dated } else { Dating::Undated(0) };
    let tables = joined::timed(joined, map, Span { first, last, dating }, &mut report)?;
    let mut inputs: Vec<Input> = constants(map)?;
    inputs.extend(topics.into_iter().flat_map(MappedTopic::into_inputs));
    for wanted in columns {
        let Some(name) = wanted.from.column.clone() else { continue };
        let (conversion, samples) = joined::samples(&tables, &wanted, &name)?;
        inputs.push(Input::read(wanted, conversion, samples));
    }
    let recording = assemble(path, &clock_name, stamps, map, inputs, &computed, &mut report)?;
    Ok((recording, report, dating))
}

/// How the topics of a bag are read.
#[derive(Default)]
struct Reading {
    auto: Auto,
    /// Signals, and the channels whose values are not theirs.
    left_out: Vec<(String, usize)>,
    /// What is said about it.
    notes: Vec<String>,
}

/// Reads the mapped topics. Where their times turn out to be of two clocks, or their values of two publishers, they are read
/// again by one of each: to keep both would take twice the memory.
fn read_topics<'m>(
    path: &Path,
    map: &'m TopicMap,
    fields: &[Wanted<'m>],
    extra: &Definitions,
) -> Result<(Vec<MappedTopic<'m>>, ReadReport), BagError> {
    let mut reading = Reading::default();
    loop {
        let (topics, mut report) = read_once(path, map, fields, extra, &reading)?;
        let (clock, _) = clock(map, &topics);
        if reading.auto == Auto::Header
            && let Some(line) = why_by_log_times(&topics, &clock)?
        {
            reading.auto = Auto::Log;
            reading.notes.push(line);
        } else if reading.left_out.is_empty() && topics.iter().any(|topic| !topic.beside_others().is_empty()) {
            for (label, Beside { number, values, values_of_other }) in
                topics.iter().flat_map(MappedTopic::beside_others)
            {
                reading.notes.push(two_publishers(&label, values, values_of_other));
                reading.left_out.push((label, number));
            }
        } else {
            report.notes.append(&mut reading.notes);
            report.notes.extend(warnings(&topics, &clock));
            return Ok((topics, report));
        }
    }
}

fn read_once<'m>(
    path: &Path,
    map: &'m TopicMap,
    fields: &[Wanted<'m>],
    extra: &Definitions,
    reading: &Reading,
) -> Result<(Vec<MappedTopic<'m>>, ReadReport), BagError> {
    let mut topics = mapped_topics(map, fields, reading)?;
    let mut messages = Messages::open(path)?;
    let (mut counts, mut report) = (TopicCounts::of(path), ReadReport::default());
    let mut first_log_time = None;
    let mut memory = 0;
    while let Some(message) = messages.next() {
        let message = message?;
        first_log_time.get_or_insert(message.log_time);
        counts.count(&message);
        if let Some(topic) = topics.iter_mut().find(|topic| topic.name == message.topic.name) {
            memory += topic.take(path, &message, extra)?;
            messages.check_memory(memory)?;
        }
    }
    counts.write_to(&mut report);
    report.damage = messages.damage();
    report.truncated_after = truncated_after(&report.damage, first_log_time);
    let found: u64 = report.messages.values().sum();
    report.missing_messages = messages.promised_messages().unwrap_or(0).saturating_sub(found);
    if messages.unreadable() > 0 {
        report.notes.push(format!("{} lines are no frames and were left out", messages.unreadable()));
    }
    for topic in &mut topics {
        topic.finish(&messages, &mut report)?;
        report.sources.insert(topic.name.clone(), topic.labels());
    }
    Ok((topics, report))
}

fn mapped_topics<'m>(
    map: &'m TopicMap,
    fields: &[Wanted<'m>],
    reading: &Reading,
) -> Result<Vec<MappedTopic<'m>>, MapError> {
    let database = match &map.dbc {
        None => None,
        Some(file) => Some(Database::read(file).map_err(|reason| MapError::Dbc { place: "dbc".to_string(), reason })?),
    };
    let mut topics: Vec<MappedTopic> = Vec::new();
    for field in fields {
        let Some(name) = field.from.topic.clone() else { continue };
        topic_of(&mut topics, &name, reading.auto).want(field.clone(), database.as_ref())?;
    }
    if let Some(name) = &map.clock.topic {
        topic_of(&mut topics, name, reading.auto);
    }
    for topic in &mut topics {
        topic.set_clock_stamp(&map.clock.stamp);
        topic.leave_out(&reading.left_out);
    }
    Ok(topics)
}

fn topic_of<'t, 'm>(topics: &'t mut Vec<MappedTopic<'m>>, name: &str, auto: Auto) -> &'t mut MappedTopic<'m> {
    let index = match topics.iter().position(|topic| topic.name == name) {
        Some(index) => index,
        None => {
            topics.push(MappedTopic::new(name, auto));
            topics.len() - 1
        }
    };
    &mut topics[index]
}

/// The stamps of the clock topic: the one in the map, otherwise the topic with the most messages.
fn clock(map: &TopicMap, topics: &[MappedTopic]) -> (String, Vec<i64>) {
    let mut best: Option<&MappedTopic> = None;
    for topic in topics {
        let better = match (&map.clock.topic, &best) {
            (Some(wanted), _) => topic.name == *wanted,
            (None, Some(best)) => topic.stamps().len() > best.stamps().len(),
            (None, None) => true,
        };
        if better {
            best = Some(topic);
        }
    }
    best.map(|topic| (topic.name.clone(), topic.stamps().to_vec())).unwrap_or_default()
}
