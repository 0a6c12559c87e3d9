//! The first lines of a text table as cells, and what they may be.

use super::cell::{self, Suffix};
use super::sampling::Sampling;
use super::split;
use super::text_lines::Line;
use super::time_text::TimeText;

/// What a cell may be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Missing,
    Number,
    Time,
    Text,
}

impl Kind {
    fn of(cell: &str) -> Kind {
        match () {
            () if ['.', ',']
                .into_iter()
                .any(|decimal| cell::read(cell, decimal).is_some_and(|(value, _)| !value.is_nan())) =>
            {
                Kind::Number
            }
            () if cell::is_missing(cell) => Kind::Missing,
            () if TimeText::of(cell).is_some() => Kind::Time,
            () => Kind::Text,
        }
    }
}

/// A line of the first ones.
pub(super) struct HeadRow<'l> {
    pub text: &'l str,
    pub cells: Vec<String>,
    pub kinds: Vec<Kind>,
    /// Cells that are not empty.
    pub filled: usize,
    /// Cells that are a number or a time.
    pub numbers: usize,
    /// Cells that are a number with a unit, as `3 bar`.
    pub with_unit: Vec<bool>,
    /// Whether the line is a comment.
    pub is_comment: bool,
    /// What it says about the sampling rate.
    pub sampling: Option<Sampling>,
}

impl<'l> HeadRow<'l> {
    pub fn of(line: &'l Line, delimiter: u8, decimal: char) -> HeadRow<'l> {
        let text = line.text.as_str();
        let is_comment = text.starts_with(['#', '%']);
        // A comment may have headings.
        let written = if is_comment { text.trim_start_matches(['#', '%', ' ']) } else { text };
        let cells = split::cells(written, delimiter);
        HeadRow {
            text,
            filled: cells.iter().filter(|cell| !cell.is_empty()).count(),
            numbers: cells.iter().filter(|cell| is_number(cell)).count(),
            kinds: cells.iter().map(|cell| Kind::of(cell)).collect(),
            with_unit: cells.iter().map(|cell| has_unit(cell)).collect(),
            is_comment,
            sampling: Sampling::of(text, delimiter, decimal),
            cells,
        }
    }

    /// Whether it has numbers or times in at least half of its cells, and in its first cell where the table has them there.
    pub fn is_data(&self, width: usize, first_is_number: bool) -> bool {
        let known = self.numbers + self.cells.iter().filter(|cell| !is_number(cell) && cell::is_missing(cell)).count();
        let first = self.cells.first().map_or("", String::as_str);
        !self.is_comment
            && self.sampling.is_none()
            && self.cells.len() == width
            && self.numbers > 0
            && 2 * known >= width
            && (!first_is_number || is_number(first) || cell::is_missing(first))
    }

    /// Whether at most half of its cells are of another kind than those of its column usually are. A date over numbers is that of the
    /// recording, not one of them.
    pub fn is_alike(&self, usual: &[Option<Kind>]) -> bool {
        let known = || self.kinds.iter().zip(usual).filter(|(kind, _)| **kind != Kind::Missing);
        let differs = known().filter(|(kind, usual)| usual.is_some_and(|usual| usual != **kind)).count();
        2 * differs <= known().count()
    }

    /// Whether its numbers with units are headings of the plain numbers in the row below: `1 bar` over forces at this pressure.
    pub fn is_over(&self, below: &HeadRow) -> bool {
        let labels = || self.with_unit.iter().enumerate().filter(|(_, has_unit)| **has_unit).map(|(place, _)| place);
        let is_plain = |place: usize| below.cells.get(place).is_some_and(|cell| is_number(cell) && !has_unit(cell));
        labels().next().is_some() && labels().all(is_plain) && self.numbers == labels().count()
    }

    /// Whether all of it is numbers, or empty.
    pub fn is_numbers(&self) -> bool {
        !self.is_comment && self.numbers > 0 && self.numbers == self.filled
    }
}

/// Whether a cell is a number with a unit.
fn has_unit(cell: &str) -> bool {
    ['.', ',']
        .into_iter()
        .any(|decimal| cell::read(cell, decimal).is_some_and(|(_, suffix)| matches!(suffix, Suffix::Unit(_))))
}

/// Whether a cell is a number with any decimal sign, or a time.
pub(super) fn is_number(cell: &str) -> bool {
    ['.', ','].into_iter().any(|decimal| cell::read(cell, decimal).is_some()) || TimeText::of(cell).is_some()
}

/// The kind that most cells of each column have, of lines of this width.
pub(super) fn usual_kinds(rows: &[HeadRow], width: usize) -> Vec<Option<Kind>> {
    let rows = || rows.iter().filter(|row| !row.is_comment && row.numbers > 0 && row.cells.len() == width);
    let of_column = |column: usize| {
        let count = |kind: Kind| rows().filter(|row| row.kinds.get(column) == Some(&kind)).count();
        let known = rows().count() - count(Kind::Missing);
        [Kind::Number, Kind::Time, Kind::Text].into_iter().find(|kind| known > 0 && 10 * count(*kind) >= 7 * known)
    };
    (0..width).map(of_column).collect()
}

/// The most frequent number of cells per line that has a number; the larger of two that are equally frequent.
pub(super) fn usual_width(rows: &[HeadRow]) -> usize {
    let with_numbers = rows.iter().filter(|row| !row.is_comment && row.numbers > 0);
    let mut widths: Vec<usize> = with_numbers.map(|row| row.cells.len()).collect();
    widths.sort_unstable();
    let longest = widths.chunk_by(|one, other| one == other).max_by_key(|same| same.len());
    longest.and_then(|same| same.first()).copied().unwrap_or(0)
}
