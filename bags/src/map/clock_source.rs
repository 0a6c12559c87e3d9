//! The clock of a map: at which times a recording has samples.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::error::MapError;

/// At which times the recording has samples.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClockSource {
    /// Bags: the topic whose stamps are the clock; without, the mapped topic with most messages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub topic: Option<String>,
    /// Bags: which stamps.
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub stamp: Stamp,
    /// Tables: the column with the time; without, `time`, `t`, `timestamp` or `stamp` if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<ColumnName>,
    /// Tables: unit of that column, `s` unless its heading says otherwise. Not for columns of dates.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Tables without time: samples per second, Hz.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f64>,
    /// Tables whose time is not since the epoch: when time 0 was, `2026-05-01T12:00:00Z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
}

/// Which time a message has.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Stamp {
    /// `header.stamp` where the type has it and it is not zero, else the log time.
    #[default]
    Auto,
    /// `header.stamp`.
    Header,
    /// When the recorder received the message.
    Log,
    /// Another field of type `builtin_interfaces/Time`, by its path.
    Field(String),
}

impl From<String> for Stamp {
    fn from(text: String) -> Self {
        match text.as_str() {
            "auto" => Stamp::Auto,
            "header" => Stamp::Header,
            "log" => Stamp::Log,
            _ => Stamp::Field(text),
        }
    }
}

impl From<Stamp> for String {
    fn from(stamp: Stamp) -> String {
        match stamp {
            Stamp::Auto => "auto".to_string(),
            Stamp::Header => "header".to_string(),
            Stamp::Log => "log".to_string(),
            Stamp::Field(path) => path,
        }
    }
}

/// A column by heading, or by number from 1.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(untagged)]
pub enum ColumnName {
    /// From 1.
    Number(usize),
    /// Heading, or name of a variable.
    Name(String),
}

impl fmt::Display for ColumnName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ColumnName::Number(number) => write!(f, "{number}"),
            ColumnName::Name(name) => f.write_str(name),
        }
    }
}

impl ClockSource {
    pub(super) fn check(&self, place: &str) -> Result<(), MapError> {
        match self.rate.filter(|rate| !(1e-6..=1e7).contains(rate)) {
            Some(found) => {
                let wanted = "between 1e-6 and 1e7 Hz";
                Err(MapError::BadNumber { place: place.to_string(), key: "rate", found, wanted })
            }
            None => Ok(()),
        }
    }
}
