//! Reads text tables: CSV in its dialects.

use std::borrow::Cow;
use std::io::{Read, Seek};

use rosbag2::ReadLimits;

use super::cell::{self, Cells, Suffix, is_missing, number};
use super::dates::parse_date;
use super::fault::TableFault;
use super::text_lines::{self, Line, Rows};
use super::{Column, Table, TableFormat, heading, preamble};
use crate::map::Unit;

/// Number of lines from which the dialect and the preamble are detected.
const LINES_LOOKED_AT: usize = 200;
/// Number of rows from which headings are detected.
const ROWS_LOOKED_AT: usize = 20;

/// Number of cells that a table may have regardless of its length, and additional cells per byte. A table of equal rows
/// has at most one cell per byte.
const FEWEST_CELLS: usize = 1000;
const CELLS_PER_BYTE: usize = 4;

/// Parses the table in a text of `bytes` bytes.
pub(super) fn parse<R: Read + Seek>(
    source: &mut R,
    bytes: u64,
    format: &TableFormat,
    limits: &ReadLimits,
) -> Result<Table, TableFault> {
    let head = text_lines::head(source, format.skip_lines, LINES_LOOKED_AT, limits.line)?;
    let Some(first_line) = head.lines.first() else {
        return Err("the table has no rows".into());
    };
    let delimiter = match format.delimiter.as_deref() {
        None => guess_delimiter(&head.lines),
        Some("whitespace" | " ") => b' ',
        Some("tab" | "\t") => b'\t',
        Some(sign) if sign.len() == 1 => sign.as_bytes()[0],
        Some(other) => return Err(format!("delimiter = \"{other}\" must be one sign, tab or whitespace").into()),
    };
    let decimal = format.decimal.unwrap_or_else(|| decimal_of(&head.lines, delimiter));
    let before = preamble::find(&head.skipped, &head.lines, delimiter, decimal);
    let start = head.lines.get(before.lines).unwrap_or(first_line).begin;
    let first = FirstRows::of(&mut Rows::new(source, start, delimiter, limits.line)?, limits)?;
    let layout = Layout::of(&first, bytes.saturating_sub(start), delimiter, format, limits)?;
    limits.check_memory((first.count * layout.names.len() * size_of::<f64>()) as u64, bytes)?;
    let mut rows = Rows::new(source, start, delimiter, limits.line)?;
    let mut table = fill(&mut rows, first, layout)?;
    table.notes.splice(0..0, before.notes);
    table.sampling = before.sampling;
    Ok(table)
}

/// The first rows, and the number of all rows.
struct FirstRows {
    rows: Vec<csv::StringRecord>,
    count: usize,
    /// Number of cells in the longest of the first rows.
    longest: usize,
}

impl FirstRows {
    fn of(rows: &mut Rows, limits: &ReadLimits) -> Result<FirstRows, TableFault> {
        let mut first = FirstRows { rows: Vec::new(), count: 0, longest: 0 };
        while let Some(row) = rows.next()? {
            if first.count < ROWS_LOOKED_AT {
                first.longest = first.longest.max(row.len());
                first.rows.push(row.iter().take(limits.fields).map(|cell| text(cell).trim().to_string()).collect());
            }
            first.count += 1;
        }
        Ok(first)
    }
}

/// The names of the columns and the start of their values.
struct Layout {
    decimal: char,
    names: Vec<String>,
    units: Vec<Option<String>>,
    /// Number of heading rows.
    headings: usize,
}

impl Layout {
    fn of(
        first: &FirstRows,
        bytes: u64,
        delimiter: u8,
        format: &TableFormat,
        limits: &ReadLimits,
    ) -> Result<Layout, TableFault> {
        let FirstRows { rows, count, longest } = first;
        let cells = || rows.iter().flatten();
        let decimal = format.decimal.unwrap_or_else(|| guess_decimal(&cells, delimiter));
        if ![',', '.'].contains(&decimal) {
            return Err(format!("decimal = \"{decimal}\" must be . or ,").into());
        }
        let has_header = format.header.unwrap_or_else(|| are_headings(rows, decimal));
        // A single broken line with many cells would create that many columns for every row of the table.
        let cells = usize::try_from(bytes).unwrap_or(usize::MAX).saturating_mul(CELLS_PER_BYTE);
        let width = (*longest).min(FEWEST_CELLS.saturating_add(cells) / (*count).max(1)).min(limits.fields);
        let (mut names, mut units) = (Vec::new(), Vec::new());
        for column in 0..width {
            let given = format.columns.get(column).map(String::as_str);
            let own = rows.first().filter(|_| has_header).and_then(|row| row.get(column));
            let (name, unit) = heading::split(given.or(own).unwrap_or_default());
            names.push(if name.is_empty() { format!("column_{}", column + 1) } else { name });
            units.push(unit);
        }
        let mut headings = usize::from(has_header);
        if has_header && rows.get(1).is_some_and(|row| is_row_of_units(row, decimal)) {
            headings = 2;
            for (unit, cell) in units.iter_mut().zip(&rows[1]) {
                *unit = Unit::named(cell.trim_matches(['[', ']', '(', ')', ' '])).map(|unit| unit.name.to_string());
            }
        }
        if *count <= headings {
            return Err("the table has headings but no rows".into());
        }
        Ok(Layout { decimal, names, units, headings })
    }
}

/// Reads the values.
fn fill(rows: &mut Rows, first: FirstRows, layout: Layout) -> Result<Table, TableFault> {
    let width = layout.names.len();
    let mut columns: Vec<Cells> = layout.units.into_iter().map(Cells::new).collect();
    let (mut number, mut ragged) = (0, 0);
    while let Some(row) = rows.next()? {
        number += 1;
        if number <= layout.headings {
            continue;
        }
        ragged += usize::from(row.len() != width);
        for (index, column) in columns.iter_mut().enumerate() {
            column.push(text(row.get(index).unwrap_or_default()).trim(), layout.decimal);
        }
    }
    let mut table = Table::default();
    if width < first.longest {
        table.notes.push(format!("a row has {} cells; only the first {width} columns were taken", first.longest));
    }
    if ragged > 0 {
        table.notes.push(format!("{ragged} rows have another number of cells than {width}"));
    }
    for (name, cells) in layout.names.into_iter().zip(columns) {
        let (unit, values) = cells.finish(&name, &mut table.notes);
        table.columns.push(Column { name, unit, values });
    }
    Ok(table)
}

fn text(cell: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(cell)
}

/// The first of tab, semicolon and comma that occurs equally often in at least 70 % of the first lines; blanks if there
/// is none. A short table after a long text is detected in the second half of these lines.
fn guess_delimiter(lines: &[Line]) -> u8 {
    let rows: Vec<&str> = lines.iter().map(|line| line.text.as_str()).filter(|line| !line.starts_with('#')).collect();
    sign_between(&rows).or_else(|| sign_between(&rows[rows.len() / 2..])).unwrap_or(b' ')
}

fn sign_between(lines: &[&str]) -> Option<u8> {
    let count = |line: &str, sign: u8| line.bytes().filter(|&byte| byte == sign).count();
    // The comma is last: many countries use it as the decimal sign.
    [b'\t', b';', b','].into_iter().find(|&sign| {
        let counts: Vec<usize> = lines.iter().map(|line| count(line, sign)).collect();
        let alike = |wanted: usize| counts.iter().filter(|&&count| count == wanted).count();
        // Only a few lines are titles or broken.
        counts.iter().any(|&count| count > 0 && 10 * alike(count) >= 7 * lines.len())
    })
}

/// The decimal sign, detected before the start of the table is known.
fn decimal_of(lines: &[Line], delimiter: u8) -> char {
    let cells = || {
        let is_between = move |c: char| if delimiter == b' ' { c.is_whitespace() } else { c == char::from(delimiter) };
        lines.iter().flat_map(move |line| line.text.split(is_between))
    };
    guess_decimal(&cells, delimiter)
}

fn guess_decimal<'c, C: Iterator<Item = &'c str>>(cells: &dyn Fn() -> C, delimiter: u8) -> char {
    let with = |sign: char| cells().filter(|cell| cell.contains(sign) && cell::read(cell, sign).is_some()).count();
    if delimiter != b',' && with(',') > with('.') { ',' } else { '.' }
}

/// Whether the first row contains headings. A missing measurement does not make a row a heading.
fn are_headings(rows: &[csv::StringRecord], decimal: char) -> bool {
    let Some((first, below)) = rows.split_first() else { return false };
    let is_plain = |cell: &str| is_missing(cell) || number(cell, decimal).is_some() || parse_date(cell).is_some();
    let has_suffix = |cell: &str| cell::read(cell, decimal).is_some_and(|(_, suffix)| suffix != Suffix::None);
    if first.iter().all(is_plain) {
        return false;
    }
    // A heading may be "5 bar", but then the cells below it are plain numbers.
    let is_row =
        |row: &csv::StringRecord| first.iter().zip(row).any(|(cell, below)| has_suffix(cell) && has_suffix(below));
    !(first.iter().all(|cell| is_plain(cell) || has_suffix(cell)) && below.iter().any(is_row))
}

/// Whether every cell is empty or a unit, and at least one is a unit.
fn is_row_of_units(row: &csv::StringRecord, decimal: char) -> bool {
    let unit = |cell: &str| Unit::named(cell.trim_matches(['[', ']', '(', ')', ' '])).is_some();
    row.iter().any(|cell| !cell.is_empty() && unit(cell) && number(cell, decimal).is_none())
        && row.iter().all(|cell| cell.is_empty() || unit(cell))
}
