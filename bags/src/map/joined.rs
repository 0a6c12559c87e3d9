//! Aligns joined tables with the times of the data.

use std::path::{Path, PathBuf};

use super::clock_source::{ClockSource, ColumnName};
use super::conversion::Conversion;
use super::document::TopicMap;
use super::error::MapError;
use super::join::Join;
use super::sparse::sparse_columns;
use super::table_clock::{Dating, TableClock, time_column};
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
    /// Stamps of columns that have their own times, by the index of the column of times.
    pub own_stamps: Vec<(usize, Vec<Option<i64>>)>,
    /// For each column, whether its filled cells are its samples.
    pub sparse: Vec<bool>,
}

impl TimedTable {
    /// A table whose rows have these stamps, moved by `shift`, ns.
    pub fn of(file: Option<PathBuf>, table: Table, clock: TableClock, source: &ClockSource, shift: i64) -> TimedTable {
        let moved = |stamps: Vec<Option<i64>>| -> Vec<Option<i64>> {
            stamps.into_iter().map(|stamp| stamp.map(|stamp| stamp.saturating_add(shift))).collect()
        };
        let of_clock = source.column.as_ref().and_then(|name| table.column(name).ok()).or_else(|| time_column(&table));
        let mut places: Vec<usize> = table.columns.iter().filter_map(|column| column.times).collect();
        places.dedup();
        let own = places.into_iter().filter_map(|place| {
            let times =
                table.columns.get(place).filter(|times| of_clock.is_none_or(|clock| !std::ptr::eq(*times, clock)))?;
            Some((place, moved(TableClock::own(times, source).ok()?.stamps)))
        });
        let own_stamps = own.collect();
        let sparse = sparse_columns(&table);
        TimedTable { file, stamps: moved(clock.stamps), own_stamps, sparse, table }
    }

    /// The stamps of the rows of a column.
    fn stamps_of(&self, column: &Column) -> &[Option<i64>] {
        let own = self.own_stamps.iter().find(|(place, _)| column.times == Some(*place));
        own.map_or(&self.stamps, |(_, stamps)| stamps)
    }

    /// Whether the filled cells of a column are its samples.
    fn is_sparse(&self, column: &Column) -> bool {
        let place = self.table.columns.iter().position(|other| std::ptr::eq(other, column));
        place.is_some_and(|place| self.sparse.get(place) == Some(&true) || column.times.is_some())
    }

    /// The stamps at which the recording has samples, ns: those of all rows, or where every column of these has its own samples,
    /// those of the column with most. It is as with topics of a bag.
    pub fn clock_of(&self, columns: &[&ColumnName]) -> Vec<i64> {
        let columns = || columns.iter().filter_map(|name| self.table.column(name).ok());
        if columns().next().is_none() || !columns().all(|column| self.is_sparse(column) && column.times.is_none()) {
            return self.stamps.iter().flatten().copied().collect();
        }
        let filled = |column: &Column| -> Vec<i64> {
            let Values::Numbers(values) = &column.values else { return Vec::new() };
            let rows = self.stamps.iter().zip(values).filter(|(_, value)| !value.is_nan());
            rows.filter_map(|(stamp, _)| *stamp).collect()
        };
        // The first of several that have equally many.
        let mut most: Vec<i64> = Vec::new();
        for own in columns().map(filled) {
            if own.len() > most.len() {
                most = own;
            }
        }
        most
    }
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
        let shift = shift(&clock, join, span)?;
        timed.push(TimedTable::of(Some(join.file.clone()), table, clock, &join.clock, shift));
    }
    Ok(timed)
}

/// What moves the stamps of a joined table to the time base of the data, ns.
fn shift(clock: &TableClock, join: &Join, span: Span) -> Result<i64, MapError> {
    let Some((first, last)) = clock.range() else {
        return Err(MapError::EmptyClock { path: join.file.clone(), clock: clock.name.clone() });
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
    Ok(shift)
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

/// The numbers of a column with their stamps, ns, and their conversion.
///
/// # Errors
/// [`MapError::NotJoined`], [`MapError::NoColumn`], [`MapError::Ambiguous`], [`MapError::ColumnLength`], and errors of
/// the conversion.
pub(super) fn samples(
    tables: &[TimedTable],
    wanted: &Wanted,
    name: &ColumnName,
) -> Result<(Conversion, Vec<(i64, f64)>), MapError> {
    let (table, column) = find(tables, wanted, name)?;
    let Values::Numbers(values) = &column.values else {
        let (unit, known) = ("date".to_string(), super::unit::Unit::names());
        return Err(MapError::UnknownUnit { signal: wanted.label.clone(), unit, known });
    };
    let stamps = table.stamps_of(column);
    if values.len() != stamps.len() {
        let (column, found) = (column.name.clone(), values.len());
        return Err(MapError::ColumnLength { column, found, expected: stamps.len() });
    }
    let conversion = wanted.conversion(column.unit.as_deref())?;
    let shift = wanted.shift();
    let is_sparse = table.is_sparse(column);
    let timed = stamps.iter().zip(values).filter(|(_, value)| !(is_sparse && value.is_nan()));
    let samples = timed.filter_map(|(stamp, &value)| Some((stamp.as_ref()?.saturating_add(shift), value)));
    Ok((conversion, samples.collect()))
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
