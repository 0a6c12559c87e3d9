//! Reads sheets of spreadsheets (.xlsx, .xlsm) as tables. A sheet is converted to text and read as a text table, so
//! that headings, units and the lines before the table are handled alike.

use std::io::{Cursor, Read};

use calamine::{DataRef, ExcelDateTime, Reader, SheetType, Xlsx, XlsxError};
use rosbag2::{Limit, ReadLimits};

use super::decimal::{Evidence, number};
use super::fault::TableFault;
use super::{Table, TableFormat, guard, text};

/// Bytes in memory for each byte of shared texts: an empty one is `<si/>`, and becomes a `String`.
const SHARED_TEXT_EXPANSION: u64 = 8;
/// Maximum number of characters of a text: headings have fewer.
const LONGEST_TEXT: usize = 200;
/// A byte that is invalid in XML text, and one that starts another encoding: after either, the content cannot be
/// checked.
const NOT_XML: [u8; 2] = [0x00, 0x1b];

/// Reads the table in a file. `Err` contains the fault in one line.
pub(super) fn parse(bytes: Vec<u8>, format: &TableFormat, limits: &ReadLimits) -> Result<Table, TableFault> {
    if bytes.starts_with(b"\xd0\xcf\x11\xe0") {
        return Err("it is an old or encrypted spreadsheet; save it as .xlsx without a password".into());
    }
    if !bytes.starts_with(b"PK") {
        return Err("it is no spreadsheet: it does not begin with PK".into());
    }
    let size = bytes.len() as u64;
    // The libraries return an error for most broken files, but panic on some.
    let sheet = guard::without_panic(|| check_sizes(&bytes, limits).and_then(|()| sheet(&bytes, format, limits)))
        .unwrap_or_else(|panic| Err(format!("the spreadsheet is broken: {panic}").into()))?;
    // The text was written in this format.
    let decimal = format.decimal.unwrap_or_else(|| sheet.evidence.decimal(b'\t'));
    if ![',', '.'].contains(&decimal) {
        return Err(format!("decimal = \"{decimal}\" must be . or ,").into());
    }
    let format = TableFormat { delimiter: Some("tab".to_string()), decimal: Some('.'), ..format.clone() };
    let text = with_points(sheet.text, decimal)?;
    let length = text.len() as u64;
    limits.check_memory(length, size)?;
    let mut table = text::parse(&mut Cursor::new(text), length, &format, limits)?;
    table.notes.extend(sheet.note);
    Ok(table)
}

/// Decompresses every part once and counts: a file can announce any size, and the library trusts it.
fn check_sizes(bytes: &[u8], limits: &ReadLimits) -> Result<(), TableFault> {
    let broken = |error: zip::result::ZipError| TableFault::from(format!("the spreadsheet is broken: {error}"));
    let size = bytes.len() as u64;
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
    Limit::Fields.check(archive.len() as u64, limits.fields as u64)?;
    let mut needed = 0_u64;
    let mut unpacked = Vec::new();
    for number in 0..archive.len() {
        let part = archive.by_index(number).map_err(broken)?;
        let name = part.name().map_err(broken)?.to_lowercase();
        if !(name.ends_with(".xml") || name.ends_with(".rels")) {
            continue;
        }
        unpacked.clear();
        let most = limits.memory_of(size).saturating_sub(needed);
        let read = part.take(most.saturating_add(1)).read_to_end(&mut unpacked);
        read.map_err(|error| format!("the spreadsheet is broken: {error}"))?;
        let is_shared_text = name.contains("sharedstrings");
        let expansion = if is_shared_text { SHARED_TEXT_EXPANSION } else { 1 };
        needed = needed.saturating_add(expansion.saturating_mul(unpacked.len() as u64));
        limits.check_memory(needed, size)?;
        if unpacked.iter().any(|byte| NOT_XML.contains(byte)) {
            return Err(format!("the spreadsheet is broken: {name} is not text in UTF-8").into());
        }
        // The library reserves space for as many texts as are announced.
        for announced in announced(&unpacked) {
            limits.check_memory(announced.saturating_mul(size_of::<String>() as u64), size)?;
        }
    }
    Ok(())
}

/// All announced counts of texts in a part.
fn announced(part: &[u8]) -> impl Iterator<Item = u64> {
    const KEY: &[u8] = b"uniqueCount";
    let places = part.windows(KEY.len()).enumerate().filter(|(_, window)| *window == KEY);
    places.map(|(at, _)| {
        let digits = part[at + KEY.len()..]
            .iter()
            .skip_while(|byte| byte.is_ascii_whitespace() || b"='\"+".contains(byte))
            .take_while(|byte| byte.is_ascii_digit());
        digits.fold(0_u64, |number, digit| number.saturating_mul(10).saturating_add(u64::from(digit - b'0')))
    })
}

/// A sheet as tab-separated text.
struct Sheet {
    text: Vec<u8>,
    /// What numbers in cells of text say about their decimal sign.
    evidence: Evidence,
    note: Option<String>,
}

fn sheet(bytes: &[u8], format: &TableFormat, limits: &ReadLimits) -> Result<Sheet, TableFault> {
    let size = bytes.len() as u64;
    let mut workbook: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(broken)?;
    let sheets: Vec<String> = workbook
        .sheets_metadata()
        .iter()
        .filter(|sheet| sheet.typ == SheetType::WorkSheet)
        .map(|sheet| sheet.name.clone())
        .collect();
    let Some(first) = sheets.first() else { return Err("the spreadsheet has no sheet with cells".into()) };
    let name = match &format.sheet {
        None => first.clone(),
        Some(wanted) if sheets.contains(wanted) => wanted.clone(),
        Some(wanted) => {
            let there = sheets.join(", ");
            return Err(format!("there is no sheet \"{wanted}\"; the spreadsheet has {there}").into());
        }
    };
    let is_1904 = workbook.has_1904_epoch();
    let mut cells = workbook.worksheet_cells_reader(&name).map_err(broken)?;
    let mut writer = csv::WriterBuilder::new()
        .delimiter(b'\t')
        .quote_style(csv::QuoteStyle::NonNumeric)
        .flexible(true)
        .from_writer(Vec::new());
    let mut row: (u32, Vec<String>) = (0, Vec::new());
    let mut evidence = Evidence::default();
    // Memory for the text written so far, and for the cells of the current row.
    let mut written = 0_u64;
    while let Some(cell) = cells.next_cell().map_err(broken)? {
        let (number, column) = cell.get_position();
        let value = shown(cell.get_value(), is_1904, &mut evidence);
        let column = column as usize;
        if value.is_empty() || column >= limits.fields {
            continue;
        }
        if number != row.0 {
            write(&mut writer, &mut row.1)?;
            row.0 = number;
        }
        if row.1.len() <= column {
            // One tab in the text, and one `String` until then.
            written = written.saturating_add(3 * (column + 1 - row.1.len()) as u64);
            row.1.resize(column + 1, String::new());
        }
        written = written.saturating_add(value.len() as u64 + 2);
        limits.check_memory(written, size)?;
        row.1[column] = value;
    }
    write(&mut writer, &mut row.1)?;
    let text = writer.into_inner().map_err(|error| TableFault::from(error.to_string()))?;
    let others = sheets.len() - 1;
    let note = (others > 0 && format.sheet.is_none()).then(|| {
        format!("sheet \"{name}\" was read; {others} more: give [table] sheet for {}", sheets[1..].join(", "))
    });
    Ok(Sheet { text, evidence, note })
}

fn write(writer: &mut csv::Writer<Vec<u8>>, row: &mut Vec<String>) -> Result<(), TableFault> {
    if row.iter().any(|cell| !cell.is_empty()) {
        writer.write_record(row.iter())?;
    }
    row.clear();
    Ok(())
}

/// A cell as text; empty for an error or an empty cell.
fn shown(value: &DataRef, is_1904: bool, evidence: &mut Evidence) -> String {
    match value {
        DataRef::Int(number) => number.to_string(),
        DataRef::Float(number) => number.to_string(),
        DataRef::Bool(truth) => u8::from(*truth).to_string(),
        DataRef::String(text) => text_or_number(text, evidence),
        DataRef::SharedString(text) => text_or_number(text, evidence),
        DataRef::DateTimeIso(text) | DataRef::DurationIso(text) => in_a_line(text),
        DataRef::DateTime(date) => date_or_time(date, is_1904),
        DataRef::Error(_) | DataRef::Empty => String::new(),
    }
}

fn in_a_line(text: &str) -> String {
    text.chars().take(LONGEST_TEXT).map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Before a number in a cell of text, whose decimal sign is known only when all cells are. No other text has it.
const NUMBER_AS_TEXT: char = '\u{1}';

/// A text; a number that was typed or imported as one is marked.
fn text_or_number(text: &str, evidence: &mut Evidence) -> String {
    let line = in_a_line(text);
    let digits = line.trim();
    let is_number = [',', '.'].into_iter().any(|decimal| number(digits, decimal).is_some_and(f64::is_finite));
    if !is_number || !digits.contains([',', '.']) {
        return line;
    }
    evidence.add(digits);
    format!("{NUMBER_AS_TEXT}{digits}")
}

/// The text of a sheet with a decimal point in all numbers; one that is none with this decimal sign stays as it is written.
fn with_points(text: Vec<u8>, decimal: char) -> Result<Vec<u8>, TableFault> {
    let mark = NUMBER_AS_TEXT as u8;
    if !text.contains(&mark) {
        return Ok(text);
    }
    let text = String::from_utf8(text).map_err(|error| TableFault::from(error.to_string()))?;
    let mut parts = text.split(NUMBER_AS_TEXT);
    let mut whole = parts.next().unwrap_or_default().to_string();
    for part in parts {
        let end = part.find(['"', '\t', '\n']).unwrap_or(part.len());
        match number(&part[..end], decimal) {
            Some(value) => whole.push_str(&value.to_string()),
            None => whole.push_str(&part[..end]),
        }
        whole.push_str(&part[end..]);
    }
    Ok(whole.into_bytes())
}

/// Day 0 of the 1900 date system, in days before 1970; and of the 1904 date system, in days after it.
const EPOCH_DAYS: f64 = 25_569.0;
const DAYS_TO_1904: f64 = 1462.0;
const SECONDS_PER_DAY: f64 = 86_400.0;

/// A date as ISO 8601, to 10 µs: a number of days resolves 0.6 µs. A duration, or a time of day without a date, in
/// seconds.
fn date_or_time(date: &ExcelDateTime, is_1904: bool) -> String {
    let days = date.as_f64();
    if date.is_duration() || days.abs() < 1.0 {
        let seconds = (days * SECONDS_PER_DAY * 1e6).round() / 1e6;
        return if seconds.is_finite() { format!("{seconds} s") } else { String::new() };
    }
    let since_epoch = days - EPOCH_DAYS + if is_1904 { DAYS_TO_1904 } else { 0.0 };
    let microseconds = 10.0 * (since_epoch * SECONDS_PER_DAY * 1e5).round();
    if microseconds.abs() > 9e17 || microseconds.is_nan() {
        return String::new();
    }
    jiff::Timestamp::from_microsecond(microseconds as i64).map_or(String::new(), |stamp| stamp.to_string())
}

fn broken(error: XlsxError) -> TableFault {
    let text = error.to_string();
    format!("the spreadsheet is broken: {}", text.lines().next().unwrap_or_default()).into()
}

#[cfg(test)]
mod tests {
    use calamine::ExcelDateTimeType;

    use super::*;

    #[test]
    fn dates_are_iso_and_times_are_seconds() {
        let shown = |days: f64, kind, is_1904| date_or_time(&ExcelDateTime::new(days, kind, is_1904), is_1904);
        let date = ExcelDateTimeType::DateTime;
        assert_eq!(shown(45_943.5, date, false), "2025-10-13T12:00:00Z");
        assert_eq!(shown(45_943.5 - 1462.0, date, true), "2025-10-13T12:00:00Z");
        assert_eq!(shown(0.5, date, false), "43200 s");
        assert_eq!(shown(1.5, ExcelDateTimeType::TimeDelta, false), "129600 s");
        for days in [f64::NAN, f64::INFINITY, 1e300, -1e300] {
            assert_eq!(shown(days, date, false), "", "{days}");
        }
    }

    #[test]
    fn counts_of_texts_are_found_however_they_are_written() {
        let found: Vec<u64> =
            announced(b"<sst uniqueCount=\"12\" x='uniqueCount' uniqueCount = '99999999999999999999999'>").collect();
        assert_eq!(found, [12, 0, u64::MAX]);
    }
}
