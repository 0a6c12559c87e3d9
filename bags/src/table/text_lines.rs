//! Reads the rows of a text table piece by piece: at most one line is in memory.

use std::cell::Cell;
use std::io::{BufRead, BufReader, Error, Read, Result, Seek, SeekFrom};
use std::rc::Rc;

use rosbag2::{Limit, LimitError};

use super::fault::TableFault;
use super::split::decoded;

/// A line and its offset.
pub(super) struct Line {
    /// Number of bytes before it.
    pub begin: u64,
    /// Without its line end.
    pub text: String,
}

/// The first lines of a text.
pub(super) struct Head {
    /// The skipped lines that are kept.
    pub skipped: Vec<String>,
    /// The lines after them that are not blank.
    pub lines: Vec<Line>,
}

/// Maximum size of the examined lines, bytes; the first few are always examined: lines can be long.
const LOOKED_AT: usize = 1 << 20;
/// Number of lines that are always examined.
const FEW_LINES: usize = 20;

/// Skips the byte order mark and `skip` lines, then reads the first `count` lines that are not blank.
pub(super) fn head<R: Read + Seek>(
    source: &mut R,
    skip: usize,
    count: usize,
    most: u64,
) -> std::result::Result<Head, TableFault> {
    source.rewind()?;
    let mut reader = BufReader::new(source);
    let mut begin = 0;
    while reader.fill_buf()?.starts_with("\u{feff}".as_bytes()) {
        reader.consume(3);
        begin += 3;
    }
    let mut head = Head { skipped: Vec::new(), lines: Vec::new() };
    let shown = |line: &[u8]| decoded(line).trim_end_matches(['\n', '\r']).to_string();
    let mut kept = 0;
    for _ in 0..skip {
        let Some(line) = line(&mut reader, most)? else { break };
        begin += line.len() as u64;
        kept += line.len();
        if kept < LOOKED_AT {
            head.skipped.push(shown(&line));
        }
    }
    let mut bytes = 0;
    while head.lines.len() < count && (bytes < LOOKED_AT || head.lines.len() < FEW_LINES) {
        let Some(line) = line(&mut reader, most)? else { break };
        let text = shown(&line);
        bytes += line.len();
        if !text.trim().is_empty() {
            head.lines.push(Line { begin, text });
        }
        begin += line.len() as u64;
    }
    head.lines = with_whole_cells(head.lines);
    Ok(head)
}

/// Maximum number of lines of one row: a heading may have a few.
const LINES_OF_A_ROW: usize = 10;

/// Joins lines that a cell in quotation marks goes across.
fn with_whole_cells(lines: Vec<Line>) -> Vec<Line> {
    let is_open = |line: &Line| line.text.bytes().filter(|byte| *byte == b'"').count() % 2 == 1;
    let mut whole: Vec<Line> = Vec::new();
    let mut lines = lines.into_iter();
    while let Some(mut line) = lines.next() {
        let mut taken = 1;
        while is_open(&line) && taken < LINES_OF_A_ROW {
            let Some(next) = lines.next() else { break };
            line.text = format!("{} {}", line.text, next.text);
            taken += 1;
        }
        whole.push(line);
    }
    whole
}

/// Number of lines from byte `start` on.
pub(super) fn count<R: Read + Seek>(source: &mut R, start: u64) -> Result<usize> {
    source.seek(SeekFrom::Start(start))?;
    let mut buffer = [0; 1 << 14];
    let mut lines = 1;
    loop {
        let read = source.read(&mut buffer)?;
        if read == 0 {
            return Ok(lines);
        }
        lines += buffer[..read].iter().filter(|byte| **byte == b'\n').count();
    }
}

/// The next line with its line end, at most `most` bytes.
fn line(reader: &mut impl BufRead, most: u64) -> Result<Option<Vec<u8>>> {
    let mut line = Vec::new();
    reader.take(most.saturating_add(1)).read_until(b'\n', &mut line)?;
    Limit::Line.check(line.len() as u64, most).map_err(Error::other)?;
    Ok(Some(line).filter(|line| !line.is_empty()))
}

/// Iterates over the rows of a table.
pub(super) struct Rows<'s> {
    reader: csv::Reader<Box<dyn Read + 's>>,
    /// Number of bytes read since the end of the last row.
    since: Rc<Cell<u64>>,
    record: csv::ByteRecord,
}

impl<'s> Rows<'s> {
    /// Reads from byte `start` of the source. If the delimiter is a blank, columns are separated by any number of
    /// blanks.
    pub fn new<R: Read + Seek>(source: &'s mut R, start: u64, delimiter: u8, most: u64) -> Result<Rows<'s>> {
        source.seek(SeekFrom::Start(start))?;
        let reader = BufReader::with_capacity(1 << 16, source);
        let (plain, delimiter): (Box<dyn Read + 's>, u8) = match delimiter {
            b' ' => (Box::new(Squeezed { reader, most, line: Vec::new(), position: 0 }), b'\t'),
            other => (Box::new(reader), other),
        };
        let since = Rc::new(Cell::new(0));
        let bounded: Box<dyn Read + 's> = Box::new(BoundedLines { reader: plain, since: Rc::clone(&since), most });
        let reader = csv::ReaderBuilder::new()
            .delimiter(delimiter)
            .has_headers(false)
            .flexible(true)
            .comment(Some(b'#'))
            .from_reader(bounded);
        Ok(Rows { reader, since, record: csv::ByteRecord::new() })
    }

    /// The next row.
    pub fn next(&mut self) -> std::result::Result<Option<&csv::ByteRecord>, TableFault> {
        let found = self.reader.read_byte_record(&mut self.record)?;
        self.since.set(0);
        Ok(found.then_some(&self.record))
    }
}

/// Returns an error if a row does not end.
struct BoundedLines<R> {
    reader: R,
    since: Rc<Cell<u64>>,
    most: u64,
}

impl<R: Read> Read for BoundedLines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let found = self.since.get();
        if found > self.most {
            return Err(Error::other(LimitError { limit: Limit::Line, found, allowed: self.most }));
        }
        let count = self.reader.read(buffer)?;
        self.since.set(found.saturating_add(count as u64));
        Ok(count)
    }
}

/// Replaces runs of blanks between columns by a single tab.
struct Squeezed<R> {
    reader: R,
    most: u64,
    line: Vec<u8>,
    position: usize,
}

impl<R: BufRead> Read for Squeezed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        if self.position == self.line.len() {
            let Some(line) = line(&mut self.reader, self.most)? else { return Ok(0) };
            let text = decoded(&line);
            let columns: Vec<&str> = text.split_whitespace().collect();
            self.line = columns.join("\t").into_bytes();
            self.line.push(b'\n');
            self.position = 0;
        }
        let rest = &self.line[self.position..];
        let count = rest.len().min(buffer.len());
        buffer[..count].copy_from_slice(&rest[..count]);
        self.position += count;
        Ok(count)
    }
}
