//! Finds where the numbers of a text table begin, and its headings and units before them.

use super::head_rows::{HeadRow, is_number, usual_kinds, usual_width};
use super::keyed_lines::{self, Channels};
use super::sampling::Sampling;
use super::split;
use super::text_lines::Line;
use crate::map::Unit;

/// Lines in a row that must be numbers where the table begins: a logger writes a few of numbers before it, as `Samples 5001 5001`.
const FIRST_ROWS: usize = 3;
/// Lines before the numbers among which headings and units are looked for.
const MOST_HEADING_LINES: usize = 24;

/// Where the numbers of a table are, and what is known of its columns.
#[derive(Debug, Default)]
pub(super) struct Layout {
    /// Index of the first line with numbers; the number of lines if there is none.
    pub data: usize,
    /// Headings as written; empty if there are none.
    pub names: Vec<String>,
    /// Units in a line of their own, as written; empty if there is none.
    pub units: Vec<String>,
    /// Whether each column of values has its own times in the column before it.
    pub has_own_times: bool,
    pub sampling: Option<Sampling>,
    pub notes: Vec<String>,
}

/// Finds the layout from the first lines. `skipped` are lines that the map leaves out. `header` says whether the first line of the
/// table has headings, if the map does.
pub(super) fn find(skipped: &[String], lines: &[Line], delimiter: u8, decimal: char, header: Option<bool>) -> Layout {
    let rows: Vec<HeadRow> = lines.iter().map(|line| HeadRow::of(line, delimiter, decimal)).collect();
    let width = usual_width(&rows[rows.len() / 2..]);
    let mut data = first_of_data(&rows, width);
    let mut layout = Layout::default();
    let mut used = Vec::new();
    match header {
        Some(true) => {
            // The line before the numbers, or the first of them.
            let names = headings(&rows[..data], width, delimiter, &mut layout, &mut used);
            if !names && data < rows.len() {
                layout.names.clone_from(&rows[data].cells);
                data += 1;
            }
        }
        Some(false) => {}
        None => {
            headings(&rows[..data], width, delimiter, &mut layout, &mut used);
        }
    }
    if layout.names.len() + 1 == width && are_row_numbers(&rows[data.min(rows.len())..]) {
        // R writes no heading over the numbers of rows.
        layout.names.insert(0, "row".to_string());
    }
    if layout.names.is_empty() {
        // Without headings, a line of the width of the table belongs to it, whatever it holds.
        while data > 0 && header == Some(false) && rows[data - 1].cells.len() == width && width > 1 {
            data -= 1;
        }
    }
    layout.data = data;
    let before = rows.get(..data).unwrap_or_default();
    let left_out = before
        .iter()
        .enumerate()
        .filter(|(index, row)| row.filled > 0 && !row.is_comment && row.sampling.is_none() && !used.contains(index));
    let left_out = left_out.count();
    if left_out > 0 {
        let are = if left_out == 1 { "line before the table was" } else { "lines before the table were" };
        layout.notes.push(format!("{left_out} {are} left out"));
    }
    let of_skipped = skipped.iter().filter_map(|line| Sampling::of(line, delimiter, decimal));
    let found = of_skipped.chain(before.iter().filter_map(|row| row.sampling.clone())).collect();
    layout.sampling = Sampling::agreed(found, &mut layout.notes);
    layout
}

/// The first line of numbers.
fn first_of_data(rows: &[HeadRow], width: usize) -> usize {
    let usual = &rows[rows.len() / 2..];
    let firsts = || usual.iter().filter(|row| !row.is_comment && row.cells.len() == width);
    let numbers = firsts().filter(|row| row.cells.first().is_some_and(|cell| is_number(cell))).count();
    let first_is_number = 2 * numbers >= firsts().count() && numbers > 0;
    let kinds = usual_kinds(usual, width);
    let is_run = |from: usize, length: usize| {
        let rows = &rows[from..];
        rows.iter().take(length).all(|row| row.is_data(width, first_is_number) && row.is_alike(&kinds))
    };
    let found = [FIRST_ROWS, 1].iter().find_map(|length| (0..rows.len()).find(|&from| is_run(from, *length)));
    match found {
        // An incomplete first row is still a row.
        Some(mut from) => {
            while from > 0 && rows[from - 1].is_numbers() && rows[from - 1].sampling.is_none() {
                from -= 1;
            }
            let is_heading = rows.get(from + 1).is_some_and(|below| rows[from].is_over(below));
            if is_heading { from + 1 } else { from }
        }
        // A table without numbers: its first line has headings, unless all of it is missing.
        None => rows.iter().position(|row| !row.is_comment).map_or(rows.len(), |first| first + 1).min(rows.len()),
    }
}

/// Finds the headings in the lines before the numbers: the last line that has as many cells as they, but for a line of units.
/// Returns whether there are any; `used` are the lines that they and the units were taken from.
fn headings(rows: &[HeadRow], width: usize, delimiter: u8, layout: &mut Layout, used: &mut Vec<usize>) -> bool {
    let first = rows.len().saturating_sub(MOST_HEADING_LINES);
    let near = || (first..rows.len()).rev();
    if let Some(channels) = keyed_lines::channels(near().map(|index| rows[index].cells.as_slice()), width) {
        used.extend(near().filter(|index| rows[*index].cells.len() == width));
        layout.of_channels(channels);
        return true;
    }
    let candidates_of = |comments: bool| -> Vec<(usize, Vec<String>)> {
        near()
            .filter(|index| rows[*index].is_comment == comments && rows[*index].sampling.is_none())
            .filter_map(|index| Some((index, fitting(&rows[index], width, delimiter)?)))
            .collect()
    };
    let mut candidates = candidates_of(false);
    if candidates.is_empty() && width > 1 {
        // numpy and others write the headings as comments; one of more words is a sentence.
        candidates = candidates_of(true);
        candidates.retain(|(_, cells)| cells.len() == width);
    }
    if let Some(place) =
        candidates.iter().position(|(_, cells)| cells.first().is_some_and(|key| keyed_lines::is_unit_key(key)))
    {
        let (index, units) = candidates.remove(place);
        used.push(index);
        layout.units = units;
    }
    let Some(place) = names_among(&candidates) else { return false };
    if layout.units.is_empty() {
        let below = candidates[..place].iter().find(|(_, cells)| has_units(cells));
        let above =
            candidates.get(place + 1).filter(|(index, cells)| index + 1 == candidates[place].0 && are_units(cells));
        if let Some((index, units)) = below.or(above) {
            used.push(*index);
            layout.units.clone_from(units);
        }
    }
    // Lines between the headings and the numbers belong to the headings.
    used.extend(candidates[..=place].iter().map(|(index, _)| *index));
    layout.names = candidates.swap_remove(place).1;
    true
}

impl Layout {
    /// Names and units of channels that have their own times.
    fn of_channels(&mut self, channels: Channels) {
        self.has_own_times = true;
        for (name, unit) in channels.names.iter().zip(channels.units) {
            let number = self.names.len() / 2 + 1;
            self.names.push(if number == 1 { "Time".to_string() } else { format!("Time of {name}") });
            self.names.push(name.clone());
            self.units.push(channels.time_unit.clone().unwrap_or_default());
            self.units.push(unit.unwrap_or_default());
        }
    }
}

/// The cells of a line, if it may be one of headings or units in a table of this width.
fn fitting(row: &HeadRow, width: usize, delimiter: u8) -> Option<Vec<String>> {
    let mut cells = row.cells.clone();
    if delimiter == b' ' && cells.len() != width {
        let wide = split::wide_cells(row.text);
        if wide.len() == width {
            cells = wide;
        }
    }
    // A key in a column of its own, before those of the table.
    let has_key =
        |cell: &String| keyed_lines::is_unit_key(cell) || keyed_lines::is_name_key(cell) || cell.ends_with(':');
    if cells.len() == width + 1
        && width > 1
        && cells.first().is_some_and(has_key)
        && cells.iter().all(|cell| !cell.is_empty())
    {
        cells.remove(0);
    }
    let filled = cells.iter().filter(|cell| !cell.is_empty()).count();
    // Numbers with a unit may be headings.
    let numbers = row.numbers - row.with_unit.iter().filter(|has_unit| **has_unit).count();
    let is_wide = cells.len() == width || (cells.len() > width && filled <= width + 1) || cells.len() + 1 == width;
    let is_filled = filled >= width.min(2) && 2 * filled >= width || has_units(&cells) && cells.len() == width;
    (width > 0 && is_wide && is_filled && 2 * numbers <= filled).then_some(cells)
}

/// Which of the lines that may be headings has them; the nearest to the numbers is the first.
fn names_among(candidates: &[(usize, Vec<String>)]) -> Option<usize> {
    let is_subtitle = |place: usize| {
        let (index, cells) = &candidates[place];
        // A line of units or of repeated words has the headings above it.
        let above = candidates.get(place + 1).filter(|(above, _)| above + 3 > *index);
        above.is_some_and(|(_, above)| {
            has_units(cells) || distinct(cells) < distinct(above) && 2 * distinct(cells) <= distinct(above)
        })
    };
    let is_named = |(_, cells): &(usize, Vec<String>)| cells.first().is_some_and(|key| keyed_lines::is_name_key(key));
    if let Some(named) = candidates.iter().position(is_named) {
        return Some(named);
    }
    // Under a line of units there may be one of remarks.
    let is_of_units = |place: &usize| {
        are_units(&candidates[*place].1)
            && candidates
                .get(place + 1)
                .is_some_and(|above| above.0 + 1 == candidates[*place].0 && above.1.iter().all(|cell| !cell.is_empty()))
    };
    if let Some(units) = (0..candidates.len()).find(is_of_units) {
        return Some(units + 1);
    }
    let mut place = 0;
    while place < candidates.len() && is_subtitle(place) {
        place += 1;
    }
    (place < candidates.len()).then_some(place)
}

fn distinct(cells: &[String]) -> usize {
    let mut cells: Vec<&String> = cells.iter().filter(|cell| !cell.is_empty()).collect();
    cells.sort_unstable();
    cells.dedup();
    cells.len()
}

/// Whether the first cells of the table are the numbers of its rows, or their names.
fn are_row_numbers(rows: &[HeadRow]) -> bool {
    let firsts: Vec<&String> = rows.iter().take(FIRST_ROWS).filter_map(|row| row.cells.first()).collect();
    let numbers: Vec<i64> = firsts.iter().filter_map(|cell| cell.parse().ok()).collect();
    let are_next =
        numbers.windows(2).all(|pair| pair[1] == pair[0] + 1) && numbers.first().is_some_and(|first| *first < 2);
    firsts.len() > 1 && ((numbers.len() == firsts.len() && are_next) || firsts.iter().all(|cell| !is_number(cell)))
}

/// A unit that is written in a cell of its own, with or without brackets.
pub(super) fn unit_in(cell: &str) -> Option<Unit> {
    Unit::named(cell.trim_matches(['[', ']', '(', ')', '{', '}', '<', '>', ' ']))
}

/// Whether a line without numbers has a unit.
fn has_units(cells: &[String]) -> bool {
    let is_unit = |cell: &String| !cell.is_empty() && unit_in(cell).is_some();
    cells.iter().any(is_unit) && !cells.iter().any(|cell| is_number(cell))
}

/// Whether a line has units and nothing else.
fn are_units(cells: &[String]) -> bool {
    has_units(cells) && cells.iter().all(|cell| cell.is_empty() || unit_in(cell).is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(text: &str, delimiter: u8) -> Layout {
        let lines: Vec<Line> = text.lines().map(|line| Line { begin: 0, text: line.to_string() }).collect();
        find(&[], &lines, delimiter, '.', None)
    }

    /// Index of the first line with numbers, number of headings, sampling rate.
    fn begins(text: &str, delimiter: u8) -> (usize, usize, Option<f64>) {
        let found = layout(text, delimiter);
        (found.data, found.names.len(), found.sampling.map(|sampling| sampling.rate))
    }

    #[test]
    fn the_numbers_begin_behind_all_that_is_none() {
        let rows = "1;2;3\n4;5;6\n7;8;9\n";
        assert_eq!(begins(&format!("a;b;c\n{rows}"), b';'), (1, 3, None));
        assert_eq!(begins(rows, b';'), (0, 0, None));
        assert_eq!(begins(&format!("Rig 3\nSampling rate: 500 Hz\na;b;c\n{rows}"), b';'), (3, 3, Some(500.0)));
        assert_eq!(begins(&format!("# fs=100\na;b;c\n{rows}"), b';'), (2, 3, Some(100.0)));
        // A spreadsheet writes the same number of cells in every line.
        assert_eq!(begins(&format!("Rig;;\nSample rate;250;\na;b;c\n{rows}"), b';'), (3, 3, Some(250.0)));
        assert_eq!(begins("Operator,Smith\nSample interval,0.001\nt,p\n0,1\n1,2\n", b','), (3, 2, Some(1000.0)));
        assert_eq!(begins("fs=1000\n1.5\n2.5\n", b' '), (1, 0, Some(1000.0)));
        // In files from R, the heading line is one cell shorter.
        assert_eq!(begins("a;b\n1;2;3\n4;5;6\n", b';'), (1, 2, None));
        // An incomplete first row is still a row.
        assert_eq!(begins(&format!("0\n{rows}"), b';'), (0, 0, None));
        assert_eq!(begins("# t x p\n0 1 2\n3 4 5\n", b' '), (1, 3, None));
        assert_eq!(begins("", b';'), (0, 0, None));
    }

    #[test]
    fn headings_are_the_last_line_of_as_many_cells() {
        let rows = "0.0\t1.5\t2\n0.1\t1.6\t2\n0.2\t1.7\t2\n";
        let logger = "Samples\t5001\t5001\nDate\t2023/11/20\t2023/11/20\nTime\t10:20:00\t10:20:00\nY_Unit_Label\tmm\tbar\n\
                      X0\t0\t0\nDelta_X\t0.1\t0.1\n***End_of_Header***\t\t\nX_Value\tPosition\tPressure\n";
        let found = layout(&format!("{logger}{rows}"), b'\t');
        assert_eq!(found.data, 8);
        assert_eq!(found.names, ["X_Value", "Position", "Pressure"]);
        assert_eq!(found.units, ["Y_Unit_Label", "mm", "bar"]);
    }

    #[test]
    fn numbers_of_rows_have_no_heading_in_r() {
        let found = layout("a b\n1 0.5 7\n2 0.6 8\n3 0.7 9\n", b' ');
        assert_eq!(found.names, ["row", "a", "b"]);
    }

    #[test]
    fn a_line_of_units_is_none_of_headings() {
        let rows = "0;1;2\n1;2;3\n2;3;4\n";
        for (head, names, units) in [
            ("t;x;p\ns;mm;bar\n", ["t", "x", "p"], ["s", "mm", "bar"]),
            ("t;x;p\n[s];[mm];[furlong]\n", ["t", "x", "p"], ["[s]", "[mm]", "[furlong]"]),
            ("t;x;p\nms;;\n", ["t", "x", "p"], ["ms", "", ""]),
            ("s;mm;bar\nt;x;p\n", ["t", "x", "p"], ["s", "mm", "bar"]),
            ("t;x;p\ns;mm;bar\n;;\n", ["t", "x", "p"], ["s", "mm", "bar"]),
            ("t;x;p\ns;mm;bar\nREAL;REAL;REAL\n", ["t", "x", "p"], ["s", "mm", "bar"]),
            ("Unit;s;mm;bar\nName;t;x;p\n", ["t", "x", "p"], ["s", "mm", "bar"]),
            ("#Name;t;x;p\n#Unit;s;mm;bar\n", ["t", "x", "p"], ["s", "mm", "bar"]),
            ("t;x;p\nsec;mm;bar\nlogged;raw data;filtered\n", ["t", "x", "p"], ["sec", "mm", "bar"]),
        ] {
            let found = layout(&format!("{head}{rows}"), b';');
            assert_eq!(
                (found.names, found.units),
                (names.map(String::from).to_vec(), units.map(String::from).to_vec()),
                "{head}"
            );
        }
    }
}
