//! Names for columns and fields.

use std::fmt;
use std::path::PathBuf;

use excavator_model::formula::ColumnFormula;
use rosbag2::dynamic::FieldPath;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::clock_source::{ColumnName, Stamp};
use super::conversion::Conversion;
use super::error::MapError;
use super::signal_source::{Resampling, check_place, check_times};

/// What a name in a formula stands for: a column of a table, or a field of a topic.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct NamedColumn {
    /// Tables: the column.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<ColumnName>,
    /// The joined file that the column is in.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<PathBuf>,
    /// Bags: the topic.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub topic: Option<String>,
    /// Bags: the field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldPath>,
    /// Topics of CAN frames: the message of the DBC file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// Unit of the numbers, which the name then has in SI; without, the name has the numbers as they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Bags: which time the message has.
    #[serde(skip_serializing_if = "super::is_default")]
    pub stamp: Stamp,
    /// Added to that time, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub time_shift: Option<f64>,
    /// Between messages or rows; without, `linear`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resample: Option<Resampling>,
    /// Longest time over which a value is interpolated or held, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maximum_gap: Option<f64>,
}

impl NamedColumn {
    /// A column of this heading or number.
    pub fn column(column: ColumnName) -> NamedColumn {
        NamedColumn { column: Some(column), ..NamedColumn::default() }
    }

    pub(super) fn check(&self, name: &str) -> Result<(), MapError> {
        if !ColumnFormula::can_name(name) {
            return Err(MapError::BadName { name: name.to_string() });
        }
        let place = format!("[names] {name}");
        let is_field = self.topic.is_some() && self.field.is_some();
        if is_field == self.column.is_some() || self.topic.is_some() != self.field.is_some() {
            return Err(MapError::NoPlace { place });
        }
        check_place(&place, self.message.is_some() && !is_field, self.file.is_some() && self.column.is_none())?;
        check_times(&place, self.maximum_gap, self.time_shift)?;
        Conversion::of_name(&place, self.unit.as_deref()).map(drop)
    }
}

/// As a table of keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    column: Option<ColumnName>,
    file: Option<PathBuf>,
    topic: Option<String>,
    field: Option<FieldPath>,
    message: Option<String>,
    unit: Option<String>,
    #[serde(default)]
    stamp: Stamp,
    time_shift: Option<f64>,
    resample: Option<Resampling>,
    maximum_gap: Option<f64>,
}

/// A heading, a number, or keys. Written by hand, since for an untagged enum serde only reports that no variant
/// matches.
struct HeadingOrKeys;

impl<'de> Visitor<'de> for HeadingOrKeys {
    type Value = NamedColumn;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a heading, the number of a column, or { column = ... } or { topic = ..., field = ... }")
    }

    fn visit_str<E: Error>(self, heading: &str) -> Result<NamedColumn, E> {
        Ok(NamedColumn::column(ColumnName::Name(heading.to_string())))
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<NamedColumn, E> {
        let number = usize::try_from(number).map_err(|_| E::custom("columns count from 1"))?;
        Ok(NamedColumn::column(ColumnName::Number(number)))
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<NamedColumn, E> {
        let number = usize::try_from(number).map_err(|_| E::custom("no table has as many columns"))?;
        Ok(NamedColumn::column(ColumnName::Number(number)))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<NamedColumn, A::Error> {
        let Keys { column, file, topic, field, message, unit, stamp, time_shift, resample, maximum_gap } =
            Keys::deserialize(MapAccessDeserializer::new(map))?;
        Ok(NamedColumn { column, file, topic, field, message, unit, stamp, time_shift, resample, maximum_gap })
    }
}

impl<'de> Deserialize<'de> for NamedColumn {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<NamedColumn, D::Error> {
        deserializer.deserialize_any(HeadingOrKeys)
    }
}
