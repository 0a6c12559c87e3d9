//! Parses the lines before the table: titles, author, sampling rate.

use super::cell;
use super::dates::parse_date;
use super::sampling::Sampling;
use super::text_lines::Line;

/// Where the table starts, and the information before it.
#[derive(Debug, Default)]
pub(super) struct Preamble {
    /// Index of the first line of the table.
    pub lines: usize,
    pub sampling: Option<Sampling>,
    pub notes: Vec<String>,
}

/// Finds the first line of the table. Skips only lines that cannot be part of it: comments, lines that are shorter than
/// its rows, and lines with the sampling rate. `skipped` are lines that the map leaves out.
pub(super) fn find(skipped: &[String], lines: &[Line], delimiter: u8, decimal: char) -> Preamble {
    let of_lines = |lines: &[&str]| -> Vec<Sampling> {
        lines.iter().filter_map(|line| Sampling::of(line, delimiter, decimal)).collect()
    };
    let skipped: Vec<&str> = skipped.iter().map(String::as_str).collect();
    let width = usual_width(lines, delimiter);
    let is_row =
        |line: &Line| is_data(&line.text, delimiter, width) && Sampling::of(&line.text, delimiter, decimal).is_none();
    let data = lines.iter().position(is_row);
    // Without a data row, it is unknown which lines are before the table.
    let before: Vec<&str> = lines.iter().take(data.unwrap_or(0)).map(|line| line.text.as_str()).collect();
    let mut begin = 0;
    for (number, line) in before.iter().enumerate() {
        let cells = cells(line, delimiter);
        let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
        // A cell continues in the next line.
        if line.matches('"').count() % 2 == 1 {
            break;
        }
        let is_short = width >= 2 && filled < (width - 1).max(2);
        let is_numbers = filled > 0 && cells.iter().all(|cell| cell.is_empty() || is_number(cell));
        if is_comment(line) || Sampling::of(line, delimiter, decimal).is_some() || (is_short && !is_numbers) {
            begin = number + 1;
        } else {
            break;
        }
    }
    // Lines before a line with the sampling rate are not headings.
    let last = before.iter().rposition(|line| Sampling::of(line, delimiter, decimal).is_some());
    let begin = begin.max(last.map_or(0, |last| last + 1));
    let mut preamble = Preamble { lines: begin, ..Preamble::default() };
    let found = [of_lines(&skipped), of_lines(&before)].concat();
    let told =
        before[..begin].iter().filter(|line| !is_comment(line) && Sampling::of(line, delimiter, decimal).is_none());
    let left_out = told.count();
    if left_out > 0 {
        let are = if left_out == 1 { "line before the table was" } else { "lines before the table were" };
        preamble.notes.push(format!("{left_out} {are} left out"));
    }
    preamble.sampling = Sampling::agreed(found, &mut preamble.notes);
    preamble
}

/// The most frequent number of cells per line; the larger of two that are equally frequent.
fn usual_width(lines: &[Line], delimiter: u8) -> usize {
    let mut widths: Vec<usize> =
        lines.iter().filter(|line| !is_comment(&line.text)).map(|line| cells(&line.text, delimiter).len()).collect();
    widths.sort_unstable();
    let longest = widths.chunk_by(|one, other| one == other).max_by_key(|same| same.len());
    longest.and_then(|same| same.first()).copied().unwrap_or(0)
}

/// Whether a line of the usual width has numbers or dates in at least half of its cells.
fn is_data(line: &str, delimiter: u8, width: usize) -> bool {
    let cells = cells(line, delimiter);
    if is_comment(line) || cells.len() != width {
        return false;
    }
    let numbers = cells.iter().filter(|cell| is_number(cell)).count();
    let known = cells.iter().filter(|cell| is_number(cell) || cell::is_missing(cell)).count();
    numbers > 0 && 2 * known >= width
}

fn is_comment(line: &str) -> bool {
    line.starts_with('#')
}

fn is_number(cell: &str) -> bool {
    ['.', ','].into_iter().any(|decimal| cell::read(cell, decimal).is_some()) || parse_date(cell).is_some()
}

fn cells(line: &str, delimiter: u8) -> Vec<&str> {
    match delimiter {
        b' ' => line.split_whitespace().collect(),
        sign => line.split(char::from(sign)).map(|cell| cell.trim().trim_matches('"').trim()).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn begins(text: &str, delimiter: u8) -> (usize, Option<f64>) {
        let lines: Vec<Line> = text.lines().map(|line| Line { begin: 0, text: line.to_string() }).collect();
        let found = find(&[], &lines, delimiter, '.');
        (found.lines, found.sampling.map(|sampling| sampling.rate))
    }

    #[test]
    fn the_table_begins_behind_what_is_no_row_of_it() {
        let rows = "1;2;3\n4;5;6\n7;8;9\n";
        assert_eq!(begins(&format!("a;b;c\n{rows}"), b';'), (0, None));
        assert_eq!(begins(rows, b';'), (0, None));
        assert_eq!(begins(&format!("Rig 3\nSampling rate: 500 Hz\na;b;c\n{rows}"), b';'), (2, Some(500.0)));
        assert_eq!(begins(&format!("# fs=100\na;b;c\n{rows}"), b';'), (1, Some(100.0)));
        // A spreadsheet writes the same number of cells in every line.
        assert_eq!(begins(&format!("Rig;;\nSample rate;250;\na;b;c\n{rows}"), b';'), (2, Some(250.0)));
        assert_eq!(begins("Operator,Smith\nSample interval,0.001\nt,p\n0,1\n1,2\n", b','), (2, Some(1000.0)));
        assert_eq!(begins("fs=1000\n1.5\n2.5\n", b' '), (1, Some(1000.0)));
        // In files from R, the heading line is one cell shorter.
        assert_eq!(begins("a;b\n1;2;3\n4;5;6\n", b';'), (0, None));
        // An incomplete first row is still a row.
        assert_eq!(begins(&format!("0\n{rows}"), b';'), (0, None));
        assert_eq!(begins("\"two\nlines\";b;c\n1;2;3\n4;5;6", b';'), (0, None));
        assert_eq!(begins("", b';'), (0, None));
    }
}
