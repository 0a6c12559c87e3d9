//! A topic of any type as columns of numbers, decoded by the definition in the bag.

use std::path::Path;

use excavator_bags::BagError;
use rosbag2::dynamic::{Definitions, FieldPath, Layout, Selector, numeric_leaves};
use rosbag2::{RawMessage, RawMessages, Topic};
use thiserror::Error;

/// Path of a message's stamp, if its type has one.
const STAMP: &str = "header.stamp";

/// A topic as columns, one entry for each message.
#[derive(Debug, Default)]
pub struct TopicColumns {
    /// When the recorder received the message, ns since the epoch.
    pub log_time: Vec<i64>,
    /// When the message was published, ns since the epoch.
    pub publish_time: Vec<i64>,
    /// Stamp in the header, ns since the epoch; `None` where the type has none.
    pub header_time: Option<Vec<i64>>,
    /// Numbers by field; `NaN` where a message has no such element.
    pub fields: Vec<(String, Vec<f64>)>,
    /// Messages that do not fit their definition and were left out.
    pub undecodable: u64,
}

/// Why a topic has no columns.
#[derive(Debug, Error)]
pub enum ColumnsError {
    /// The bag cannot be read.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The definition or a field cannot be used.
    #[error("topic {topic}: {reason}")]
    Topic {
        /// The topic.
        topic: String,
        /// What is wrong.
        reason: String,
    },
}

/// Decodes the messages of one topic into numbers.
struct Decoder {
    layout: Layout,
    stamp: Option<Selector>,
    selectors: Vec<Selector>,
}

impl Decoder {
    /// A decoder of these fields, or of every number in the first message.
    fn new(first: &RawMessage, wanted: Option<&[String]>) -> Result<(Decoder, Vec<String>), ColumnsError> {
        let topic: &Topic = &first.topic;
        let wrong = |reason: String| ColumnsError::Topic { topic: topic.name.clone(), reason };
        let layout = Layout::of_topic(topic, &Definitions::default()).map_err(|error| wrong(error.to_string()))?;
        let paths: Vec<FieldPath> = match wanted {
            Some(names) => names
                .iter()
                .map(|name| name.parse::<FieldPath>().map_err(|error| wrong(format!("{error}"))))
                .collect::<Result<_, _>>()?,
            None => numeric_leaves(&layout, &first.data).map_err(|error| wrong(error.to_string()))?,
        };
        let selectors = paths
            .iter()
            .map(|path| Selector::number(&layout, path).map_err(|error| wrong(error.to_string())))
            .collect::<Result<_, _>>()?;
        let stamp = STAMP.parse::<FieldPath>().ok().and_then(|path| Selector::time(&layout, &path).ok());
        let names = paths.iter().map(ToString::to_string).collect();
        Ok((Decoder { layout, stamp, selectors }, names))
    }

    /// Adds all numbers of one message to the columns, or none if one fails.
    fn push(&self, message: &RawMessage, row: &mut Vec<f64>, columns: &mut TopicColumns) {
        row.clear();
        let numbers = self.selectors.iter().map(|selector| selector.read(&self.layout, &message.data));
        let stamp = self.stamp.as_ref().map(|stamp| stamp.read_time(&self.layout, &message.data));
        let is_whole =
            numbers.map(|number| number.map(|number| row.push(number.unwrap_or(f64::NAN)))).all(|one| one.is_ok());
        let stamp = match stamp {
            None => None,
            Some(Ok(Some(stamp))) if is_whole => Some(stamp),
            Some(_) => {
                columns.undecodable += 1;
                return;
            }
        };
        if !is_whole {
            columns.undecodable += 1;
            return;
        }
        columns.log_time.push(message.log_time as i64);
        columns.publish_time.push(message.publish_time as i64);
        if let (Some(times), Some(stamp)) = (&mut columns.header_time, stamp) {
            times.push(stamp);
        }
        columns.fields.iter_mut().zip(row.iter()).for_each(|((_, column), number)| column.push(*number));
    }
}

/// Reads one topic of the bag at `path`: the given fields, or every number of its first message.
///
/// # Errors
/// [`ColumnsError`] if the bag, the topic, its definition or a field cannot be read.
pub fn topic_columns(path: &Path, name: &str, fields: Option<&[String]>) -> Result<TopicColumns, ColumnsError> {
    let mut messages = RawMessages::open(path).map_err(BagError::from)?;
    let mut columns = TopicColumns::default();
    let mut decoder: Option<Decoder> = None;
    let mut row = Vec::new();
    for message in &mut messages {
        let message = message.map_err(BagError::from)?;
        if message.topic.name != name {
            continue;
        }
        if decoder.is_none() {
            let (made, names) = Decoder::new(&message, fields)?;
            columns.header_time = made.stamp.is_some().then(Vec::new);
            columns.fields = names.into_iter().map(|name| (name, Vec::new())).collect();
            decoder = Some(made);
        }
        if let Some(decoder) = &decoder {
            decoder.push(&message, &mut row, &mut columns);
        }
    }
    let topics = messages.topics();
    if decoder.is_none() && !topics.iter().any(|topic| topic.name == name) {
        let existing = topics.iter().map(|topic| topic.name.clone()).collect();
        return Err(BagError::NoTopic { path: path.to_path_buf(), topic: name.to_string(), existing }.into());
    }
    Ok(columns)
}
