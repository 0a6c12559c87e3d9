//! Aligns joined tables with the times of the data.

use std::path::{Path, PathBuf};

use super::clock_source::ColumnName;
use super::document::TopicMap;
use super::error::MapError;
use super::join::Join;
use super::table_clock::{Dating, TableClock};
use super::wanted::Wanted;
use crate::BagError;
use crate::reading::ReadReport;
use crate::table::{Column, Table, Values};

/// A table and the stamps of its rows.
pub(super) struct TimedTable {
    /// As written in the map; `None` for the data themselves.
    pub file: Option<PathBuf>,
    pub table: Table,
    /// One per row, ns since the epoch; `None` for rows without time.
    pub stamps: Vec<Option<i64>>,
}

/// The time span of the data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    /// First and last stamp, ns.
    pub first: i64,
    pub last: i64,
    pub dating: Dating,
}

/// The tables that a map joins, without their times, since headings are needed first.
///
/// # Errors
/// Errors of [`Table::read`].
pub(super) fn read(data: &Path, map: &TopicMap) -> Result<Vec<Table>, BagError> {
    let folder = data.parent().unwrap_or(Path::new("."));
    map.join.iter().map(|join| Table::read(&folder.join(&join.file), &join.table)).collect()
}

/// Aligns joined tables with the times of the data.
///
/// # Errors
/// Errors of [`TableClock::of`]; [`MapError::OneIsUndated`], [`MapError::Apart`].
pub(super) fn timed(
    tables: Vec<Table>,
    map: &TopicMap,
    span: Span,
    report: &mut ReadReport,
) -> Result<Vec<TimedTable>, MapError> {
    let mut timed = Vec::new();
    for (table, join) in tables.into_iter().zip(&map.join) {
        let shown = join.file.display();
        report.notes.extend(table.notes.iter().map(|note| format!("{shown}: {note}")));
        let rows = table.columns.iter().map(|column| column.values.len()).max().unwrap_or(0);
        let clock = TableClock::of(&table, &join.clock, rows)?;
        report.notes.extend(clock.note.iter().map(|note| format!("{shown}: {note}")));
        let stamps = aligned(clock, join, span)?;
        timed.push(TimedTable { file: Some(join.file.clone()), table, stamps });
    }
    Ok(timed)
}

/// The stamps of a joined table on the time base of the data.
fn aligned(clock: TableClock, join: &Join, span: Span) -> Result<Vec<Option<i64>>, MapError> {
    let Some((first, last)) = clock.range() else {
        return Err(MapError::EmptyClock { path: join.file.clone(), clock: clock.name });
    };
    let offset = (join.offset.unwrap_or(0.0) * 1e9).round() as i64;
    let from_first_row = span.first.saturating_sub(first);
    let shift = match (span.dating, clock.dating) {
        (Dating::Dated, Dating::Dated) => 0,
        (Dating::Undated(zero), Dating::Undated(own)) => zero.saturating_sub(own),
        // Rows without time start with the data.
        (_, Dating::Counted) | (Dating::Counted, Dating::Undated(_)) => from_first_row,
        _ if join.offset.is_some() => from_first_row,
        (_, dating) => {
            return Err(MapError::OneIsUndated { file: join.file.clone(), is_dated: dating == Dating::Dated });
        }
    };
    let shift = shift.saturating_add(offset);
    let seconds = |stamp: i64| stamp.saturating_add(shift).saturating_sub(span.first) as f64 / 1e9;
    let duration = span.last.saturating_sub(span.first) as f64 / 1e9;
    if seconds(first) > duration || seconds(last) < 0.0 {
        return Err(MapError::Apart { file: join.file.clone(), from: seconds(first), to: seconds(last), duration });
    }
    Ok(clock.stamps.into_iter().map(|stamp| stamp.map(|stamp| stamp.saturating_add(shift))).collect())
}

/// The headings that formulas may use: those of the data and of all joined files, each once.
pub(super) fn headings(own: Option<&Table>, joined: &[Table]) -> Vec<String> {
    let mut headings: Vec<String> = Vec::new();
    for table in own.into_iter().chain(joined) {
        for column in &table.columns {
            if !headings.contains(&column.name) {
                headings.push(column.name.clone());
            }
        }
    }
    headings
}

/// The values of a column with their stamps, ns.
///
/// # Errors
/// [`MapError::NotJoined`], [`MapError::NoColumn`], [`MapError::Ambiguous`], [`MapError::ColumnLength`], and errors of
/// the conversion.
pub(super) fn samples(tables: &[TimedTable], wanted: &Wanted, name: &ColumnName) -> Result<Vec<(i64, f64)>, MapError> {
    let (table, column) = find(tables, wanted, name)?;
    let Values::Numbers(values) = &column.values else {
        let (unit, known) = ("date".to_string(), super::unit::Unit::names());
        return Err(MapError::UnknownUnit { signal: wanted.label.clone(), unit, known });
    };
    if values.len() != table.stamps.len() {
        let (column, found) = (column.name.clone(), values.len());
        return Err(MapError::ColumnLength { column, found, expected: table.stamps.len() });
    }
    let conversion = wanted.conversion(column.unit.as_deref())?;
    let shift = wanted.shift();
    let timed = table.stamps.iter().zip(values);
    Ok(timed
        .filter_map(|(stamp, &value)| Some((stamp.as_ref()?.saturating_add(shift), conversion.apply(value))))
        .collect())
}

fn find<'t>(
    tables: &'t [TimedTable],
    wanted: &Wanted,
    name: &ColumnName,
) -> Result<(&'t TimedTable, &'t Column), MapError> {
    let in_one = |table: &'t TimedTable| Ok((table, table.table.column(name)?));
    if let Some(file) = wanted.file() {
        let joined = tables.iter().filter_map(|table| table.file.clone());
        let found = tables.iter().find(|table| table.file.as_deref() == Some(file));
        let place = wanted.label.clone();
        let missing = || MapError::NotJoined { place, file: file.to_path_buf(), joined: joined.collect() };
        return in_one(found.ok_or_else(missing)?);
    }
    let own = tables.iter().find(|table| table.file.is_none());
    let joined: Vec<&TimedTable> = tables.iter().filter(|table| table.file.is_some()).collect();
    match (own.map(in_one), name) {
        (Some(Ok(found)), _) => Ok(found),
        // A column number is ambiguous without its file.
        (Some(error), ColumnName::Number(_)) => error,
        (own, _) => {
            let found: Vec<_> = joined.iter().filter_map(|table| in_one(table).ok()).collect();
            match (found.as_slice(), own) {
                ([one], _) => Ok(*one),
                ([], Some(error)) if joined.is_empty() => error,
                ([], _) => Err(MapError::NoColumn {
                    wanted: name.to_string(),
                    existing: tables.iter().flat_map(|t| t.table.columns.iter().map(|c| c.name.clone())).collect(),
                }),
                (several, _) => Err(MapError::Ambiguous {
                    place: wanted.label.clone(),
                    column: name.to_string(),
                    files: several.iter().filter_map(|(table, _)| table.file.clone()).collect(),
                }),
            }
        }
    }
}
