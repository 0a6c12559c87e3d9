//! A topic map in text form.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use excavator_model::document::toml_fault;
use rosbag2::dynamic::FieldPath;
use rosbag2::{ReadLimits, read_regular_text};
use serde::{Deserialize, Serialize};

use super::conversion::Conversion;
use super::error::MapError;
use super::join::Join;
use super::leave_out::LeaveOut;
use super::named::NamedColumn;
use super::quantity::Quantity;
use super::signal::SignalName;
use crate::BagError;
use crate::table::TableFormat;

/// Which field of which topic, or which column of which table, is which signal.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TopicMap {
    /// What the map is for, for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// `.msg` files with types that neither the bag nor we define; relative to the map's own file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub definitions: Vec<PathBuf>,
    /// DBC file that says where signals stand in CAN frames; relative to the map's own file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dbc: Option<PathBuf>,
    /// At which times the recording has samples.
    #[serde(default, skip_serializing_if = "is_default")]
    pub clock: ClockSource,
    /// How a text table is laid out; most of it is found out without.
    #[serde(default, skip_serializing_if = "is_default")]
    pub table: TableFormat,
    /// Other tables of the same time, whose columns are available too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub join: Vec<Join>,
    /// Names for columns and fields, for formulas.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub names: BTreeMap<String, NamedColumn>,
    /// The signals; what is not here is not measured.
    #[serde(default)]
    pub signals: Vec<SignalSource>,
    /// What is not compared with a model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub leave_out: Vec<LeaveOut>,
}

/// At which times the recording has samples.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ClockSource {
    /// Bags: the topic whose stamps are the clock; without, the mapped topic with most messages.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub topic: Option<String>,
    /// Bags: which stamps.
    #[serde(default, skip_serializing_if = "is_default")]
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

/// The value of a signal between the messages that carry it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Resampling {
    /// On the straight line between the message before and the one after.
    Linear,
    /// That of the message before.
    Hold,
}

/// Where one signal comes from, and how its numbers become SI values:
/// value = `sign` · `scale` · (number in `unit`, as SI) + `offset`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SignalSource {
    /// The signal: `arm.displacement`, `pump_pressure`.
    pub signal: SignalName,
    /// Bags: the topic.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub topic: Option<String>,
    /// Bags: the field.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldPath>,
    /// Topics of CAN frames: the message of the DBC file; `field` is a signal of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Tables: the column.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub column: Option<ColumnName>,
    /// The joined file that the column is in; without, the data themselves, else the joined file that has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// None of these: a formula over columns, names and other signals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// None of these: a known constant, in SI or with its unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<Quantity>,
    /// Unit of the numbers; SI when not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Factor; with its unit where `unit` measures something else than the signal (`"25 bar/V"`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<Quantity>,
    /// Added last; in the unit of the signal, not of the numbers.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<Quantity>,
    /// -1 turns the direction around.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sign: Option<i8>,
    /// Bags: which time the message has.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stamp: Stamp,
    /// Added to that time, s: negative for a sensor whose stamps are late.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_shift: Option<f64>,
    /// Between messages; without, `linear`, and `hold` for commands.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resample: Option<Resampling>,
    /// Longest time over which a value is interpolated or held, s; beyond it the signal is not measured. Without, five
    /// median intervals of its own for `linear`, no limit for `hold`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum_gap: Option<f64>,
}

impl SignalSource {
    /// A signal of which only the name is known yet.
    pub fn new(signal: SignalName) -> SignalSource {
        SignalSource {
            signal,
            topic: None,
            field: None,
            message: None,
            column: None,
            file: None,
            formula: None,
            value: None,
            unit: None,
            scale: None,
            offset: None,
            sign: None,
            stamp: Stamp::Auto,
            time_shift: None,
            resample: None,
            maximum_gap: None,
        }
    }

    fn check(&self) -> Result<(), MapError> {
        let signal = self.signal.to_string();
        let is_field = self.topic.is_some() && self.field.is_some();
        let sources = [is_field, self.column.is_some(), self.formula.is_some(), self.value.is_some()];
        let is_half_a_field = self.topic.is_some() != self.field.is_some();
        if is_half_a_field || sources.iter().filter(|given| **given).count() != 1 {
            return Err(MapError::NoSource { signal });
        }
        check_place(&signal, self.message.is_some() && !is_field, self.file.is_some() && self.column.is_none())?;
        check_times(&signal, self.maximum_gap, self.time_shift)?;
        // The column heading or the DBC file may still provide the unit, so a missing unit is not an error here.
        if self.column.is_none() && self.message.is_none() || self.unit.is_some() {
            Conversion::of(self, None)?;
        }
        Ok(())
    }
}

/// Rejects keys that specify details of a source that is not given.
pub(super) fn check_place(place: &str, message_of_nothing: bool, file_of_nothing: bool) -> Result<(), MapError> {
    for (wrong, key, wanted) in
        [(message_of_nothing, "message", "`topic` and `field`"), (file_of_nothing, "file", "`column`")]
    {
        if wrong {
            return Err(MapError::KeyWithout { place: place.to_string(), key, wanted });
        }
    }
    Ok(())
}

/// Rejects invalid times (s).
pub(super) fn check_times(place: &str, maximum_gap: Option<f64>, time_shift: Option<f64>) -> Result<(), MapError> {
    let bad = |key, found, wanted| MapError::BadNumber { place: place.to_string(), key, found, wanted };
    if let Some(gap) = maximum_gap.filter(|gap| !(gap.is_finite() && *gap > 0.0)) {
        return Err(bad("maximum_gap", gap, "positive"));
    }
    if let Some(shift) = time_shift.filter(|shift| shift.is_nan() || shift.abs() > 1e6) {
        return Err(bad("time_shift", shift, "under 1e6 s"));
    }
    Ok(())
}

impl TopicMap {
    /// Reads the map at `path`; paths of its definition files are relative to it.
    ///
    /// # Errors
    /// [`rosbag2::Error::Io`], [`BagError::Map`].
    pub fn read(path: &Path) -> Result<TopicMap, BagError> {
        let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
        let mut map: TopicMap =
            text.parse().map_err(|source| MapError::InFile { path: path.to_path_buf(), source: Box::new(source) })?;
        let folder = path.parent().unwrap_or(Path::new("."));
        for beside in map.definitions.iter_mut().chain(&mut map.dbc) {
            *beside = folder.join(&*beside);
        }
        Ok(map)
    }

    /// The map file of a bag or table, if it exists: `map.toml` in the folder of a bag, or `FILE.map.toml` next to a
    /// file.
    pub fn beside(data: &Path) -> Option<PathBuf> {
        let path = if data.is_dir() {
            data.join("map.toml")
        } else {
            let mut name = data.file_name()?.to_os_string();
            name.push(".map.toml");
            data.with_file_name(name)
        };
        path.is_file().then_some(path)
    }

    /// The map as text that parses back to the same map.
    ///
    /// # Errors
    /// [`MapError::Syntax`] if TOML cannot represent a number.
    pub fn to_text(&self) -> Result<String, MapError> {
        toml::to_string(self).map_err(|error| MapError::Syntax(error.to_string().into()))
    }

    fn check(&self) -> Result<(), MapError> {
        if self.signals.is_empty() {
            return Err(MapError::NoSignals);
        }
        let mut seen = BTreeSet::new();
        for source in &self.signals {
            if !seen.insert(&source.signal) {
                return Err(MapError::SignalTwice { signal: source.signal.to_string() });
            }
            source.check()?;
            if source.message.is_some() && self.dbc.is_none() {
                return Err(MapError::NoDbc { place: source.signal.to_string() });
            }
        }
        for (name, named) in &self.names {
            named.check(name)?;
            if named.message.is_some() && self.dbc.is_none() {
                return Err(MapError::NoDbc { place: format!("[names] {name}") });
            }
        }
        self.join.iter().try_for_each(Join::check)?;
        self.clock.check("[clock]")
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

impl FromStr for TopicMap {
    type Err = MapError;

    fn from_str(text: &str) -> Result<Self, MapError> {
        let map: TopicMap = toml::from_str(text).map_err(|error| MapError::Syntax(toml_fault(text, &error)))?;
        map.check()?;
        Ok(map)
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
