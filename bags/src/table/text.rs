//! Text tables: CSV in its dialects.

use super::dates::parse_date;
use super::{Column, Table, TableFormat, Values, heading};
use crate::map::Unit;

/// Lines from which dialect and headings are told.
const LINES_LOOKED_AT: usize = 20;

/// Cells that a table may have whatever its length, and beyond that for each of its bytes. A table of equal rows has one
/// cell in a byte at most.
const FEWEST_CELLS: usize = 1000;
const CELLS_PER_BYTE: usize = 4;

/// The table in the text. `Err` says in one line what is wrong.
pub(super) fn parse(bytes: &[u8], format: &TableFormat) -> Result<Table, String> {
    let text = String::from_utf8_lossy(bytes);
    let text = after_lines(text.trim_start_matches('\u{feff}'), format.skip_lines);
    if text.trim().is_empty() {
        return Err("the table has no rows".to_string());
    }
    let delimiter = match format.delimiter.as_deref() {
        None => guess_delimiter(text),
        Some("whitespace" | " ") => b' ',
        Some("tab" | "\t") => b'\t',
        Some(sign) if sign.len() == 1 => sign.as_bytes()[0],
        Some(other) => return Err(format!("delimiter = \"{other}\" must be one sign, tab or whitespace")),
    };
    let squeezed;
    let (text, delimiter) = if delimiter == b' ' {
        squeezed = squeeze(text);
        (squeezed.as_str(), b'\t')
    } else {
        (text, delimiter)
    };
    let rows = rows(text, delimiter)?;
    let decimal = format.decimal.unwrap_or_else(|| guess_decimal(&rows, delimiter));
    if ![',', '.'].contains(&decimal) {
        return Err(format!("decimal = \"{decimal}\" must be . or ,"));
    }
    let has_header = format.header.unwrap_or_else(|| {
        // A measurement that is missing in the first row makes no heading of it.
        rows.first().is_some_and(|row| row.iter().any(|cell| is_word(cell, decimal)))
    });
    let longest = rows.iter().take(LINES_LOOKED_AT).map(csv::StringRecord::len).max().unwrap_or(0);
    // One broken line of many cells would make as many columns of as many rows as the table has.
    let width = longest.min((FEWEST_CELLS + CELLS_PER_BYTE * text.len()) / rows.len().max(1));
    let (mut names, mut units) = (Vec::new(), Vec::new());
    for column in 0..width {
        let given = format.columns.get(column).map(String::as_str);
        let own = rows.first().filter(|_| has_header).and_then(|row| row.get(column));
        let (name, unit) = heading::split(given.or(own).unwrap_or_default());
        names.push(if name.is_empty() { format!("column_{}", column + 1) } else { name });
        units.push(unit);
    }
    let mut first = usize::from(has_header);
    if has_header && rows.get(1).is_some_and(|row| is_row_of_units(row, decimal)) {
        first = 2;
        for (unit, cell) in units.iter_mut().zip(&rows[1]) {
            *unit = Unit::named(cell.trim_matches(['[', ']', '(', ')', ' '])).map(|unit| unit.name.to_string());
        }
    }
    let mut table = Table::default();
    let body = rows.get(first..).unwrap_or_default();
    if body.is_empty() {
        return Err("the table has headings but no rows".to_string());
    }
    if width < longest {
        table.notes.push(format!("a row has {longest} cells; only the first {width} columns were taken"));
    }
    let ragged = body.iter().filter(|row| row.len() != width).count();
    if ragged > 0 {
        table.notes.push(format!("{ragged} rows have another number of cells than {width}"));
    }
    for (index, (name, unit)) in names.into_iter().zip(units).enumerate() {
        let cells = body.iter().map(|row| row.get(index).unwrap_or_default());
        let (values, bad) = values(cells, decimal);
        if bad > 0 {
            table.notes.push(format!("column {name}: {bad} cells are no number and were taken as not measured"));
        }
        table.columns.push(Column { name, unit, values });
    }
    Ok(table)
}

fn after_lines(text: &str, count: usize) -> &str {
    (0..count).fold(text, |rest, _| rest.split_once('\n').map_or("", |(_, after)| after))
}

fn rows(text: &str, delimiter: u8) -> Result<Vec<csv::StringRecord>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    reader.records().collect::<Result<_, _>>().map_err(|error| error.to_string())
}

/// The sign that stands equally often in the first lines, most often; blanks if none does.
fn guess_delimiter(text: &str) -> u8 {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).take(LINES_LOOKED_AT).collect();
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

/// Columns with single tabs between them.
fn squeeze(text: &str) -> String {
    let lines = text.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join("\t"));
    lines.collect::<Vec<_>>().join("\n")
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

/// The values of one column and how many cells are neither number nor empty. A column is one of dates if its first
/// cell is.
fn values<'c>(cells: impl Iterator<Item = &'c str> + Clone, decimal: char) -> (Values, usize) {
    let mut bad = 0;
    let first = cells.clone().find(|cell| !is_missing(cell)).unwrap_or_default();
    if parse_date(first).is_some() {
        let stamps = cells.map(|cell| {
            let stamp = parse_date(cell);
            bad += usize::from(stamp.is_none() && !is_missing(cell));
            stamp
        });
        return (Values::Stamps(stamps.collect()), bad);
    }
    let numbers = cells
        .map(|cell| {
            number(cell, decimal).unwrap_or_else(|| {
                bad += usize::from(!is_missing(cell));
                f64::NAN
            })
        })
        .collect();
    (Values::Numbers(numbers), bad)
}
