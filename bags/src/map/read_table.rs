//! Reads the mapped columns of a table as tracks.

use std::path::Path;

use excavator_model::recording::Recording;

use super::assemble::{Input, assemble, constants};
use super::clock_source::ColumnName;
use super::document::TopicMap;
use super::error::MapError;
use super::joined::{self, Span, TimedTable};
use super::table_clock::{Dating, TableClock};
use super::wanted::{Wanted, wanted};
use crate::BagError;
use crate::reading::ReadReport;
use crate::table::{Column, Table, heading_of};

/// Reads the signals of a map from a table. Also returns the kind of the row times.
pub(super) fn read_table(
    path: &Path,
    table: Table,
    map: &TopicMap,
) -> Result<(Recording, ReadReport, Dating), BagError> {
    let not_a_topic =
        |signal: String| MapError::WrongSource { signal, found: "topic", path: path.to_path_buf(), wanted: "table" };
    if map.clock.topic.is_some() {
        return Err(not_a_topic("the clock".to_string()).into());
    }
    let mut report = ReadReport { notes: table.notes.clone(), ..ReadReport::default() };
    let joined = joined::read(path, map)?;
    let (wanted, computed) = wanted(map, &joined::headings(Some(&table), &joined))?;
    if let Some(wrong) = wanted.iter().find(|wanted| wanted.from.column.is_none()) {
        return Err(not_a_topic(wrong.label.clone()).into());
    }
    let clock = TableClock::of(&table, &map.clock, rows(&table, &wanted))?;
    report.notes.extend(clock.note.iter().cloned());
    let Some((first, last)) = clock.range() else {
        let own = format!("column {}: ", clock.name);
        let example = report.notes.iter().find_map(|note| note.strip_prefix(&own)).map(str::to_string);
        return Err(MapError::NoTimes { path: path.to_path_buf(), column: clock.name, example }.into());
    };
    let rows = clock.stamps.iter().flatten().count();
    if first == last && rows > 1 {
        // A date alone, or a time to the minute.
        let example = Some(format!("all {rows} rows have the same"));
        return Err(MapError::NoTimes { path: path.to_path_buf(), column: clock.name, example }.into());
    }
    let joined = joined::timed(joined, map, Span { first, last, dating: clock.dating }, &mut report)?;
    let (clock_name, dating) = (clock.name.clone(), clock.dating);
    let mut tables = vec![TimedTable::of(None, table, clock, &map.clock, 0)];
    tables.extend(joined);
    let mut inputs: Vec<Input> = constants(map)?;
    let of_data = wanted.iter().filter(|wanted| wanted.file().is_none() && wanted.signal.is_some());
    let of_data: Vec<&ColumnName> = of_data.filter_map(|wanted| wanted.from.column.as_ref()).collect();
    let stamps = tables[0].clock_of(&of_data);
    for wanted in wanted {
        let Some(name) = wanted.from.column.clone() else { continue };
        let (conversion, samples) = joined::samples(&tables, &wanted, &name)?;
        inputs.push(Input::read(wanted, conversion, samples));
    }
    let without_time = tables[0].stamps.iter().filter(|stamp| stamp.is_none()).count();
    if without_time > 0 {
        report.notes.push(format!("{without_time} rows without time were left out"));
    }
    report.messages.insert("rows".to_string(), rows as u64);
    if stamps.len() < rows {
        report.notes.push(format!(
            "the table has several topics: its {rows} rows make {} samples, as many as the column with most has values",
            stamps.len()
        ));
    }
    let recording = assemble(path, &clock_name, stamps, map, inputs, &computed, &mut report)?;
    Ok((recording, report, dating))
}

/// Rows of the first column that the map refers to; columns of a MATLAB file can have different lengths.
fn rows(table: &Table, wanted: &[Wanted]) -> usize {
    let own = wanted.iter().filter(|wanted| wanted.file().is_none());
    let first = own.filter_map(|wanted| table.column(wanted.from.column.as_ref()?).ok()).next();
    let longest = || table.columns.iter().map(|column| column.values.len()).max().unwrap_or(0);
    first.map_or_else(longest, |column| column.values.len())
}

impl Table {
    /// The column with this heading, with or without its unit.
    pub fn named(&self, name: &str) -> Option<&Column> {
        let find = |fits: &dyn Fn(&Column) -> bool| self.columns.iter().find(|column| fits(column));
        let (bare, unit) = heading_of(name);
        find(&|column| column.name == *name)
            .or_else(|| find(&|column| unit.is_some() && column.name == bare && column.unit == unit))
            .or_else(|| find(&|column| column.name.eq_ignore_ascii_case(name)))
    }

    /// The column with this name, or with this number from 1. A name may include the unit of the heading.
    pub(super) fn column(&self, name: &ColumnName) -> Result<&Column, MapError> {
        let found = match name {
            ColumnName::Number(number) => number.checked_sub(1).and_then(|index| self.columns.get(index)),
            ColumnName::Name(name) => self.named(name),
        };
        found.ok_or_else(|| MapError::NoColumn {
            wanted: name.to_string(),
            existing: self.columns.iter().map(|column| column.name.clone()).collect(),
        })
    }
}
