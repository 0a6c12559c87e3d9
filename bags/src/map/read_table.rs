//! Mapped columns of a table as tracks.

use std::path::Path;

use excavator_model::recording::Recording;

use super::assemble::{Samples, assemble};
use super::conversion::Conversion;
use super::document::{ColumnName, SignalSource, TopicMap};
use super::error::MapError;
use super::read_bag::{constants, in_order_of_map};
use super::unit::{Dimension, Unit};
use crate::reading::ReadReport;
use crate::table::{Column, Table, Values};

/// Headings that are taken for the time when the map names no column.
const TIME_NAMES: [&str; 6] = ["time", "t", "timestamp", "stamp", "zeit", "time_s"];
/// Time 0 of a table that says nothing else: 1 January 2000. Not the epoch, since a stamp of zero means "not set".
const DEFAULT_START: i64 = 946_684_800_000_000_000;
/// Numbers above this are seconds since the epoch (1973 and later), below it since the start of the recording.
const EPOCH_SECONDS: f64 = 1e8;

/// Reads the signals of a map from a table.
pub(super) fn read_table(path: &Path, table: &Table, map: &TopicMap) -> Result<(Recording, ReadReport), MapError> {
    if map.clock.topic.is_some() {
        let signal = "the clock".to_string();
        return Err(MapError::WrongSource { signal, found: "topic", path: path.to_path_buf(), wanted: "table" });
    }
    let mut report = ReadReport { notes: table.notes.clone(), ..ReadReport::default() };
    let (clock_name, stamps) = clock(table, map)?;
    let mut signals: Vec<(&SignalSource, Samples)> = constants(map)?;
    for source in map.signals.iter().filter(|source| source.value.is_none()) {
        let Some(name) = &source.column else {
            let signal = source.signal.to_string();
            return Err(MapError::WrongSource { signal, found: "topic", path: path.to_path_buf(), wanted: "table" });
        };
        let column = table.column(name)?;
        let Values::Numbers(values) = &column.values else {
            let unit = "date".to_string();
            return Err(MapError::UnknownUnit { signal: source.signal.to_string(), unit, known: Unit::names() });
        };
        if values.len() != stamps.len() {
            let (column, found) = (column.name.clone(), values.len());
            return Err(MapError::ColumnLength { column, found, expected: stamps.len() });
        }
        let conversion = Conversion::of(source, column.unit.as_deref())?;
        let shift = (source.time_shift.unwrap_or(0.0) * 1e9).round() as i64;
        let timed = stamps
            .iter()
            .zip(values)
            .filter_map(|(stamp, &value)| Some((stamp.as_ref()?.saturating_add(shift), conversion.apply(value))));
        signals.push((source, Samples::Timed(timed.collect())));
    }
    in_order_of_map(map, &mut signals);
    let without_time = stamps.iter().filter(|stamp| stamp.is_none()).count();
    if without_time > 0 {
        report.notes.push(format!("{without_time} rows without time were left out"));
    }
    let stamps: Vec<i64> = stamps.into_iter().flatten().collect();
    report.messages.insert("rows".to_string(), stamps.len() as u64);
    let recording = assemble(path, &clock_name, stamps, signals, &mut report)?;
    Ok((recording, report))
}

/// Name of the clock and the stamp of each row, ns since the epoch; `None` for rows without time.
fn clock(table: &Table, map: &TopicMap) -> Result<(String, Vec<Option<i64>>), MapError> {
    let start = map.clock.start.as_deref().map(parse_start).transpose()?;
    if let Some(rate) = map.clock.rate {
        let rows = map.signals.iter().find_map(|source| Some(table.column(source.column.as_ref()?)));
        let rows = rows.transpose()?.map_or(0, |column| column.values.len());
        let start = start.unwrap_or(DEFAULT_START);
        let stamp = |row: usize| start.checked_add((row as f64 / rate * 1e9).round() as i64);
        return Ok((format!("{rate} rows per second"), (0..rows).map(stamp).collect()));
    }
    let column = match &map.clock.column {
        Some(name) => table.column(name)?,
        None => time_column(table).ok_or(MapError::NoClock)?,
    };
    let name = column.name.clone();
    match &column.values {
        Values::Stamps(stamps) => Ok((name, stamps.clone())),
        Values::Numbers(times) => {
            let unit = map.clock.unit.as_deref().or(column.unit.as_deref()).unwrap_or("s");
            let unit = Unit::named(unit).filter(|unit| unit.dimension == Dimension::Time).ok_or_else(|| {
                let known = "s, ms, us, ns, min, h".to_string();
                MapError::UnknownUnit { signal: "[clock]".to_string(), unit: unit.to_string(), known }
            })?;
            let first = times.iter().copied().find(|time| time.is_finite()).map_or(0.0, |time| unit.to_si(time));
            let start = start.unwrap_or(if first > EPOCH_SECONDS { 0 } else { DEFAULT_START });
            let stamp = |&time: &f64| {
                let nanoseconds = (unit.to_si(time) * 1e9).round();
                // What a stamp cannot hold is no time.
                let holds = nanoseconds.abs() < 9e18;
                holds.then(|| start.checked_add(nanoseconds as i64)).flatten()
            };
            Ok((name, times.iter().map(stamp).collect()))
        }
    }
}

/// The column that is most likely the time: one of dates, else one with a usual heading.
pub(super) fn time_column(table: &Table) -> Option<&Column> {
    let by_name = |column: &&Column| TIME_NAMES.contains(&column.name.to_lowercase().as_str());
    let dates = table.columns.iter().find(|column| matches!(column.values, Values::Stamps(_)));
    dates.or_else(|| table.columns.iter().find(by_name))
}

fn parse_start(text: &str) -> Result<i64, MapError> {
    crate::table::parse_date(text)
        .ok_or_else(|| MapError::BadStart { text: text.to_string(), reason: "it is no date with time".to_string() })
}

impl Table {
    /// The column of this name, or of this number from 1.
    pub(super) fn column(&self, name: &ColumnName) -> Result<&Column, MapError> {
        let found = match name {
            ColumnName::Number(number) => number.checked_sub(1).and_then(|index| self.columns.get(index)),
            ColumnName::Name(name) => self
                .columns
                .iter()
                .find(|column| column.name == *name)
                .or_else(|| self.columns.iter().find(|column| column.name.eq_ignore_ascii_case(name))),
        };
        found.ok_or_else(|| MapError::NoColumn {
            wanted: name.to_string(),
            existing: self.columns.iter().map(|column| column.name.clone()).collect(),
        })
    }
}
