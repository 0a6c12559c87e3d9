//! Determines when the rows of a table were recorded.

use super::clock_source::ClockSource;
use super::day_serial;
use super::error::MapError;
use super::unit::{Dimension, Unit};
use crate::table::{Column, Table, Values};

/// Headings recognised as time if the map names no column.
const TIME_NAMES: [&str; 14] = [
    "time",
    "t",
    "timestamp",
    "stamp",
    "zeit",
    "time_s",
    "__time",
    "x_value",
    "time stamp",
    "elapsed time",
    "zeitstempel",
    "uhrzeit",
    "datetime",
    "date/time",
];
/// Time 0 of a table without a date: 1 January 2000. Not the epoch, since a stamp of zero means "not set".
const DEFAULT_START: i64 = 946_684_800_000_000_000;
/// ns of a day.
const DAY: i64 = 86_400_000_000_000;
/// Larger numbers are seconds since the epoch (1973 and later), smaller ones are seconds since the start of the
/// recording.
pub(super) const EPOCH_SECONDS: f64 = 1e8;

/// The meaning of stamps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dating {
    /// Absolute time of the row.
    Dated,
    /// Time since a time 0 of the table, whose stamp this is.
    Undated(i64),
    /// Number of previous rows.
    Counted,
}

/// The times of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TableClock {
    /// For display.
    pub name: String,
    /// One per row, ns since the epoch; `None` for rows without time.
    pub stamps: Vec<Option<i64>>,
    pub dating: Dating,
    /// Information from lines before the table.
    pub note: Option<String>,
}

impl TableClock {
    /// The times of a table according to a map. `rows` is the number of rows.
    ///
    /// # Errors
    /// [`MapError::NoColumn`], [`MapError::NoClock`], [`MapError::UnknownUnit`], [`MapError::BadStart`].
    pub fn of(table: &Table, clock: &ClockSource, rows: usize) -> Result<TableClock, MapError> {
        let start = clock.start.as_deref().map(parse_start).transpose()?;
        if let Some(rate) = clock.rate {
            return Ok(TableClock::even(rate, rows, start, None));
        }
        let column = match &clock.column {
            Some(name) => Some(table.column(name)?),
            None => time_column(table),
        };
        match (column, &table.sampling) {
            (Some(column), _) => TableClock::of_column(column, clock, start),
            (None, Some(sampling)) => {
                let (rate, line) = (sampling.rate, &sampling.line);
                let note = format!("no column of times: {rate} rows per second, as the line \"{line}\" says");
                Ok(TableClock::even(rate, rows, start, Some(note)))
            }
            (None, None) => Err(MapError::NoClock),
        }
    }

    /// The times of columns that have their own.
    ///
    /// # Errors
    /// [`MapError::UnknownUnit`], [`MapError::BadStart`].
    pub fn own(times: &Column, clock: &ClockSource) -> Result<TableClock, MapError> {
        let start = clock.start.as_deref().map(parse_start).transpose()?;
        TableClock::of_column(times, clock, start)
    }

    fn even(rate: f64, rows: usize, start: Option<i64>, note: Option<String>) -> TableClock {
        let zero = start.unwrap_or(DEFAULT_START);
        let stamp = |row: usize| zero.checked_add((row as f64 / rate * 1e9).round() as i64);
        let dating = if start.is_some() { Dating::Dated } else { Dating::Counted };
        TableClock { name: format!("{rate} rows per second"), stamps: (0..rows).map(stamp).collect(), dating, note }
    }

    fn of_column(column: &Column, clock: &ClockSource, start: Option<i64>) -> Result<TableClock, MapError> {
        let name = column.name.clone();
        let times = match &column.values {
            Values::Stamps(stamps) => {
                return Ok(TableClock { name, stamps: stamps.clone(), dating: Dating::Dated, note: None });
            }
            Values::Numbers(times) => times,
        };
        let are_days = clock.unit.is_none() && column.unit.is_none() && day_serial::are_days(times);
        let note = are_days.then(|| {
            format!("column {name} is read in days: as seconds, its steps would be too small; give [clock] unit if it is something else")
        });
        let usual = if are_days { "d" } else { "s" };
        let unit = clock.unit.as_deref().or(column.unit.as_deref()).unwrap_or(usual);
        let unit = Unit::named(unit).filter(|unit| unit.dimension == Dimension::Time).ok_or_else(|| {
            let known = "s, ms, us, ns, min, h, d".to_string();
            MapError::UnknownUnit { signal: "[clock]".to_string(), unit: unit.to_string(), known }
        })?;
        let first = times.iter().copied().find(|time| time.is_finite()).map_or(0.0, |time| unit.to_si(time));
        let days = if unit.name == "d" { day_serial::epoch(first / unit.factor()) } else { None };
        let (zero, dating) = match (start, days) {
            (_, Some(_)) => (0, Dating::Dated),
            (Some(start), _) => (start, Dating::Dated),
            (None, None) if first > EPOCH_SECONDS => (0, Dating::Dated),
            (None, None) => (DEFAULT_START, Dating::Undated(DEFAULT_START)),
        };
        let stamp = |&time: &f64| {
            let nanoseconds = (unit.to_si(time - days.unwrap_or(0.0)) * 1e9).round();
            // A time that does not fit in a stamp is treated as missing.
            let holds = nanoseconds.abs() < 9e18;
            holds.then(|| zero.checked_add(nanoseconds as i64)).flatten()
        };
        Ok(TableClock { name, stamps: times.iter().map(stamp).collect(), dating, note })
    }

    /// The earliest and the latest stamp, ns; `None` without any.
    pub fn range(&self) -> Option<(i64, i64)> {
        let stamps = || self.stamps.iter().flatten().copied();
        stamps().min().zip(stamps().max())
    }
}

/// The column that is most likely the time: one of dates, otherwise one with a common heading.
pub(super) fn time_column(table: &Table) -> Option<&Column> {
    let has_times = |column: &&Column| match &column.values {
        Values::Numbers(numbers) => numbers.iter().any(|number| number.is_finite()),
        Values::Stamps(_) => true,
    };
    let by_name = |column: &&Column| {
        TIME_NAMES.contains(&column.name.to_lowercase().as_str()) && (has_times(column) || table.sampling.is_none())
    };
    let dates = table.columns.iter().find(|column| match &column.values {
        // A column of days says nothing of the time between rows.
        Values::Stamps(stamps) => stamps.iter().flatten().any(|stamp| stamp % DAY != 0),
        Values::Numbers(_) => false,
    });
    dates.or_else(|| table.columns.iter().find(by_name))
}

fn parse_start(text: &str) -> Result<i64, MapError> {
    crate::table::parse_date(text)
        .ok_or_else(|| MapError::BadStart { text: text.to_string(), reason: "it is no date with time".to_string() })
}
