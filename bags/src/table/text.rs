//! Reads text tables: CSV in its dialects.

use std::io::{Cursor, Read, Seek};

use rosbag2::ReadLimits;

use super::cell::{self, Cells};
use super::decimal::Evidence;
use super::fault::TableFault;
use super::headings::Headings;
use super::split::{self, decoded};
use super::text_lines::{self, Line, Rows};
use super::{Column, Table, TableFormat, Values, clock_columns, encoding, layout};

/// Number of lines from which the dialect and the layout are detected: headers of loggers have hundreds.
const LINES_LOOKED_AT: usize = 1000;
/// Fewest lines at the end of the first ones from which the sign between columns is detected.
const FEWEST_LINES: usize = 4;
/// Number of rows from which the number of columns is detected.
const ROWS_LOOKED_AT: usize = 20;

/// Number of cells that a table may have regardless of its length, and additional cells per byte. A table of equal rows
/// has at most one cell per byte.
const FEWEST_CELLS: usize = 1000;
const CELLS_PER_BYTE: usize = 4;

/// Parses the table in a text of `bytes` bytes, in any encoding.
pub(super) fn parse<R: Read + Seek>(
    source: &mut R,
    bytes: u64,
    format: &TableFormat,
    limits: &ReadLimits,
) -> Result<Table, TableFault> {
    match encoding::in_utf8(source, bytes, limits)? {
        Some(text) => {
            let length = text.len() as u64;
            in_bytes(&mut Cursor::new(text), length, format, limits)
        }
        None => in_bytes(source, bytes, format, limits),
    }
}

/// Parses the table in a text whose signs between cells are single bytes.
fn in_bytes<R: Read + Seek>(
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
    let decimal = format.decimal.unwrap_or_else(|| decimal_of(&head.lines, delimiter));
    if ![',', '.'].contains(&decimal) {
        return Err(format!("decimal = \"{decimal}\" must be . or ,").into());
    }
    let layout = layout::find(&head.skipped, &head.lines, delimiter, decimal, format.header);
    let Some(first_line) = head.lines.get(layout.data) else {
        return Err("the table has headings but no rows".into());
    };
    // Lines before the numbers may have other decimal signs.
    let decimal = format.decimal.unwrap_or_else(|| decimal_of(&head.lines[layout.data..], delimiter));
    let start = first_line.begin;
    let first = FirstRows::of(source, start, delimiter, limits)?;
    if first.count == 0 {
        return Err("the table has headings but no rows".into());
    }
    // A column may be empty in all of the first rows.
    let width = first.width(layout.names.len(), bytes.saturating_sub(start), limits);
    limits.check_memory((first.count * width * size_of::<f64>()) as u64, bytes)?;
    let headings = Headings::of(&layout, width, format);
    let mut rows = Rows::new(source, start, delimiter, limits.line)?;
    let mut table = fill(&mut rows, &first, headings, decimal)?;
    table.notes.splice(0..0, layout.notes);
    table.sampling = layout.sampling;
    Ok(table)
}

/// The number of cells in the longest of the first rows, and the largest possible number of all rows.
struct FirstRows {
    count: usize,
    longest: usize,
}

impl FirstRows {
    fn of<R: Read + Seek>(
        source: &mut R,
        start: u64,
        delimiter: u8,
        limits: &ReadLimits,
    ) -> Result<FirstRows, TableFault> {
        let mut first = FirstRows { count: 0, longest: 0 };
        let mut rows = Rows::new(source, start, delimiter, limits.line)?;
        for _ in 0..ROWS_LOOKED_AT {
            let Some(row) = rows.next()? else { break };
            first.longest = first.longest.max(row.len());
            first.count += 1;
        }
        drop(rows);
        if first.count == ROWS_LOOKED_AT {
            first.count = first.count.max(text_lines::count(source, start)?);
        }
        Ok(first)
    }

    /// Number of columns of a table with this many bytes. A single broken line with many cells would create that many columns for
    /// every row of the table.
    fn width(&self, names: usize, bytes: u64, limits: &ReadLimits) -> usize {
        let cells = usize::try_from(bytes).unwrap_or(usize::MAX).saturating_mul(CELLS_PER_BYTE);
        self.longest.max(names).min(FEWEST_CELLS.saturating_add(cells) / self.count.max(1)).min(limits.fields)
    }
}

/// Reads the values.
fn fill(rows: &mut Rows, first: &FirstRows, headings: Headings, decimal: char) -> Result<Table, TableFault> {
    let width = headings.columns.len();
    let mut columns: Vec<Cells> = headings.columns.iter().map(|column| Cells::new(column.unit.clone())).collect();
    // Rows may end before columns that are empty throughout.
    let usual = first.longest.min(width);
    let mut ragged = 0;
    while let Some(row) = rows.next()? {
        ragged += usize::from(row.len() != usual);
        for (index, column) in columns.iter_mut().enumerate() {
            column.push(decoded(row.get(index).unwrap_or_default()).trim(), decimal);
        }
    }
    let mut table = Table { notes: headings.notes, ..Table::default() };
    if width < first.longest {
        table.notes.push(format!("a row has {} cells; only the first {width} columns were taken", first.longest));
    }
    if ragged > 0 {
        table.notes.push(format!("{ragged} rows have another number of cells than {usual}"));
    }
    let mut kinds = Vec::new();
    for (heading, cells) in headings.columns.into_iter().zip(columns) {
        let (unit, values, kind) = cells.finish(&heading.name, &mut table.notes);
        kinds.push(kind);
        table.columns.push(Column { name: heading.name, unit, values, times: heading.times });
    }
    clock_columns::combine(&mut table, &kinds);
    // Rows that end with a sign between columns have an empty column behind the last.
    while table.columns.len() > 1 && table.columns.last().is_some_and(|last| is_nothing(last, table.columns.len())) {
        table.columns.pop();
    }
    Ok(table)
}

/// Whether a column has neither a heading nor a value.
fn is_nothing(column: &Column, number: usize) -> bool {
    let is_empty = matches!(&column.values, Values::Numbers(numbers) if numbers.iter().all(|value| value.is_nan()));
    is_empty && column.name == format!("column_{number}")
}

/// The first of tab, semicolon and comma that occurs equally often in at least 70 % of the first lines; blanks if there
/// is none. A short table after a long text is detected in the last half or quarter of these lines.
fn guess_delimiter(lines: &[Line]) -> u8 {
    let rows: Vec<&str> = lines.iter().map(|line| line.text.as_str()).filter(|line| !line.starts_with('#')).collect();
    let parts = [0, rows.len() / 2, rows.len() - rows.len() / 4];
    let parts = parts.into_iter().filter(|&from| from == 0 || rows.len() - from >= FEWEST_LINES);
    parts.filter_map(|from| sign_between(&rows[from..])).next().unwrap_or(b' ')
}

fn sign_between(lines: &[&str]) -> Option<u8> {
    // The comma is last: many countries use it as the decimal sign.
    [b'\t', b';', b','].into_iter().find(|&sign| {
        let counts: Vec<usize> = lines.iter().map(|line| split::count(line, sign)).collect();
        let alike = |wanted: usize| counts.iter().filter(|&&count| count == wanted).count();
        // Only a few lines are titles or broken.
        counts.iter().any(|&count| count > 0 && 10 * alike(count) >= 7 * lines.len())
    })
}

/// The decimal sign of the numbers in these lines.
fn decimal_of(lines: &[Line], delimiter: u8) -> char {
    let mut evidence = Evidence::default();
    for cell in lines.iter().flat_map(|line| split::cells(&line.text, delimiter)) {
        let (digits, rest) = cell.split_at(cell::end_of_number(&cell));
        if rest.is_empty() || cell::unit(rest.trim_start()).is_some() {
            evidence.add(digits);
        }
    }
    evidence.decimal(delimiter)
}
