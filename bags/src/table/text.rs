//! Text tables: CSV in its dialects.

use std::borrow::Cow;
use std::io::{Read, Seek};

use super::dates::parse_date;
use super::fault::TableFault;
use super::text_lines::{self, Rows};
use super::{Column, Table, TableFormat, Values, heading};
use crate::limits::ReadLimits;
use crate::map::Unit;

/// Lines from which dialect and headings are told.
const LINES_LOOKED_AT: usize = 20;

/// Cells that a table may have whatever its length, and beyond that for each of its bytes. A table of equal rows has one
/// cell in a byte at most.
const FEWEST_CELLS: usize = 1000;
const CELLS_PER_BYTE: usize = 4;

/// The table in a text of so many bytes.
pub(super) fn parse<R: Read + Seek>(
    source: &mut R,
    bytes: u64,
    format: &TableFormat,
    limits: &ReadLimits,
) -> Result<Table, TableFault> {
    let head = text_lines::head(source, format.skip_lines, LINES_LOOKED_AT, limits.line)?;
    if head.lines.is_empty() {
        return Err("the table has no rows".into());
    }
    let delimiter = match format.delimiter.as_deref() {
        None => guess_delimiter(&head.lines),
        Some("whitespace" | " ") => b' ',
        Some("tab" | "\t") => b'\t',
        Some(sign) if sign.len() == 1 => sign.as_bytes()[0],
        Some(other) => return Err(format!("delimiter = \"{other}\" must be one sign, tab or whitespace").into()),
    };
    let first = FirstRows::of(&mut Rows::new(source, head.start, delimiter, limits.line)?, limits)?;
    let layout = Layout::of(&first, bytes.saturating_sub(head.start), delimiter, format, limits)?;
    limits.check_memory((first.count * layout.names.len() * size_of::<f64>()) as u64, bytes)?;
    let mut rows = Rows::new(source, head.start, delimiter, limits.line)?;
    fill(&mut rows, first, layout)
}

/// The first rows, and how many there are in all.
struct FirstRows {
    rows: Vec<csv::StringRecord>,
    count: usize,
    /// Cells of the longest of the first rows.
    longest: usize,
}

impl FirstRows {
    fn of(rows: &mut Rows, limits: &ReadLimits) -> Result<FirstRows, TableFault> {
        let mut first = FirstRows { rows: Vec::new(), count: 0, longest: 0 };
        while let Some(row) = rows.next()? {
            if first.count < LINES_LOOKED_AT {
                first.longest = first.longest.max(row.len());
                first.rows.push(row.iter().take(limits.fields).map(|cell| text(cell).trim().to_string()).collect());
            }
            first.count += 1;
        }
        Ok(first)
    }
}

/// What the columns are called and where their values begin.
struct Layout {
    decimal: char,
    names: Vec<String>,
    units: Vec<Option<String>>,
    /// Rows of headings.
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
        let decimal = format.decimal.unwrap_or_else(|| guess_decimal(rows, delimiter));
        if ![',', '.'].contains(&decimal) {
            return Err(format!("decimal = \"{decimal}\" must be . or ,").into());
        }
        let has_header = format.header.unwrap_or_else(|| {
            // A measurement that is missing in the first row makes no heading of it.
            rows.first().is_some_and(|row| row.iter().any(|cell| is_word(cell, decimal)))
        });
        // One broken line of many cells would make as many columns of as many rows as the table has.
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
    let mut columns: Vec<Cells> = (0..width).map(|_| Cells::default()).collect();
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
    for ((name, unit), cells) in layout.names.into_iter().zip(layout.units).zip(columns) {
        if cells.bad > 0 {
            let bad = cells.bad;
            table.notes.push(format!("column {name}: {bad} cells are no number and were taken as not measured"));
        }
        table.columns.push(Column { name, unit, values: cells.into_values() });
    }
    Ok(table)
}

fn text(cell: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(cell)
}

/// The sign that stands equally often in the first lines, most often; blanks if none does.
fn guess_delimiter(lines: &[String]) -> u8 {
    let count = |line: &str, sign: u8| line.bytes().filter(|&byte| byte == sign).count();
    // The comma last: in half of the world it is the decimal sign.
    for sign in [b'\t', b';', b','] {
        let counts: Vec<usize> = lines.iter().map(|line| count(line, sign)).collect();
        let alike = |wanted: usize| counts.iter().filter(|&&count| count == wanted).count();
        // Titles and broken lines are few.
        if counts.iter().any(|&count| count > 0 && 10 * alike(count) >= 7 * lines.len()) {
            return sign;
        }
    }
    b' '
}

fn guess_decimal(rows: &[csv::StringRecord], delimiter: u8) -> char {
    let cells = || rows.iter().take(LINES_LOOKED_AT).flatten();
    let with_comma = cells().filter(|cell| cell.contains(',') && number(cell, ',').is_some()).count();
    let with_point = cells().filter(|cell| cell.contains('.') && number(cell, '.').is_some()).count();
    if delimiter != b',' && with_comma > with_point { ',' } else { '.' }
}

/// The number in a cell.
fn number(cell: &str, decimal: char) -> Option<f64> {
    let cell = cell.trim();
    if decimal == '.' {
        return cell.parse().ok();
    }
    // With a decimal comma a point would group thousands.
    cell.replace('.', "").replace(',', ".").parse().ok()
}

fn is_missing(cell: &str) -> bool {
    let cell = cell.trim();
    cell.is_empty() || ["nan", "na", "n/a", "null", "none", "-", "--"].contains(&cell.to_lowercase().as_str())
}

fn is_word(cell: &str, decimal: char) -> bool {
    !is_missing(cell) && number(cell, decimal).is_none() && parse_date(cell).is_none()
}

/// Whether every cell is empty or a unit, and at least one is a unit.
fn is_row_of_units(row: &csv::StringRecord, decimal: char) -> bool {
    let unit = |cell: &str| Unit::named(cell.trim_matches(['[', ']', '(', ')', ' '])).is_some();
    row.iter().any(|cell| !cell.is_empty() && unit(cell) && number(cell, decimal).is_none())
        && row.iter().all(|cell| cell.is_empty() || unit(cell))
}

/// The values of one column as far as they are read.
#[derive(Default)]
struct Cells {
    /// `None` before the first cell that is not empty: a column is one of dates if that is a date.
    values: Option<Values>,
    /// Empty cells before the first other one.
    missing: usize,
    /// Cells that are neither number nor empty.
    bad: usize,
}

impl Cells {
    fn push(&mut self, cell: &str, decimal: char) {
        if self.values.is_none() {
            if is_missing(cell) {
                self.missing += 1;
                return;
            }
            self.values = Some(match parse_date(cell) {
                Some(_) => Values::Stamps(vec![None; self.missing]),
                None => Values::Numbers(vec![f64::NAN; self.missing]),
            });
        }
        match &mut self.values {
            Some(Values::Stamps(stamps)) => {
                let stamp = parse_date(cell);
                self.bad += usize::from(stamp.is_none() && !is_missing(cell));
                stamps.push(stamp);
            }
            Some(Values::Numbers(numbers)) => numbers.push(number(cell, decimal).unwrap_or_else(|| {
                self.bad += usize::from(!is_missing(cell));
                f64::NAN
            })),
            None => {}
        }
    }

    fn into_values(self) -> Values {
        self.values.unwrap_or_else(|| Values::Numbers(vec![f64::NAN; self.missing]))
    }
}
