//! Parses numbers in cells: plain, with an SI prefix (`3.3k`), or with a unit (`25.1 mm`); collects the cells of a
//! column.

use super::Values;
use super::decimal::number;
use super::time_cells::{TimeCells, TimeKind};
use super::time_text::TimeText;
use crate::map::Unit;

/// SI prefixes that directly follow a number without a unit, and their factors. K is the kelvin.
const PREFIXES: [(&str, f64); 9] =
    [("G", 1e9), ("M", 1e6), ("k", 1e3), ("m", 1e-3), ("u", 1e-6), ("µ", 1e-6), ("μ", 1e-6), ("n", 1e-9), ("p", 1e-12)];

/// Longest part of a cell that is shown in a note, characters.
const LONGEST_SHOWN: usize = 20;

/// The suffix of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Suffix {
    None,
    /// A prefix; the number is already multiplied by it.
    Prefix,
    /// An `m` without a blank: the prefix milli, unless the column is in metres.
    Milli,
    Unit(&'static str),
}

/// The number in a cell and its suffix.
pub(super) fn read(cell: &str, decimal: char) -> Option<(f64, Suffix)> {
    let cell = cell.trim();
    if let Some(number) = number(cell, decimal) {
        return Some((number, Suffix::None));
    }
    let (digits, rest) = cell.split_at(end_of_number(cell));
    if !digits.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let number = number(digits, decimal)?;
    let name = rest.trim_start();
    // A prefix directly follows its number; after a blank there is a unit.
    if name.len() == rest.len()
        && let Some((prefix, factor)) = PREFIXES.iter().find(|(prefix, _)| *prefix == name)
    {
        let scaled = if *factor < 1.0 { number / (1.0 / factor).round() } else { number * factor };
        return Some((scaled, if *prefix == "m" { Suffix::Milli } else { Suffix::Prefix }));
    }
    unit(name).map(|unit| (number, Suffix::Unit(unit)))
}

/// A unit after a number. Stricter than in a heading: `5-` is not a number with a unit `-`, and `5 M` is not in metres.
pub(super) fn unit(name: &str) -> Option<&'static str> {
    let found = Unit::named(name)?.name;
    let initial = |text: &str| text.chars().next();
    let other_case = initial(name).zip(initial(found)).is_some_and(|(a, b)| a != b && a.eq_ignore_ascii_case(&b));
    let changes_meaning = other_case && (name.len() == 1 || name.starts_with(['m', 'M']));
    (!["1", "-"].contains(&found) && !changes_meaning).then_some(found)
}

/// Length in bytes of the number at the start of a text: sign, digits and separators, exponent.
pub(super) fn end_of_number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = usize::from(text.starts_with(['+', '-']));
    while bytes.get(end).is_some_and(|byte| byte.is_ascii_digit() || [b'.', b','].contains(byte)) {
        end += 1;
    }
    if bytes.get(end).is_some_and(|byte| [b'e', b'E'].contains(byte)) {
        let sign = usize::from(bytes.get(end + 1).is_some_and(|byte| [b'+', b'-'].contains(byte)));
        let digits = bytes[end + 1 + sign..].iter().take_while(|byte| byte.is_ascii_digit()).count();
        if digits > 0 {
            end += 1 + sign + digits;
        }
    }
    end
}

/// Whether a cell marks a missing value.
pub(super) fn is_missing(cell: &str) -> bool {
    let cell = cell.trim();
    cell.is_empty() || ["nan", "na", "n/a", "null", "none", "-", "--"].contains(&cell.to_lowercase().as_str())
}

/// The values of one column read so far. The first cell that is a number or a time decides which of them the column has.
enum Known {
    Nothing,
    Numbers(Vec<f64>),
    Times(TimeCells),
}

/// The cells of one column read so far.
pub(super) struct Cells {
    values: Known,
    /// Number of cells before the first value.
    missing: usize,
    /// Number of cells that are neither a number nor empty, and the first of them.
    bad: usize,
    first_bad: String,
    /// Unit in the heading.
    heading: Option<String>,
    /// Unit of all cells, if the heading gives none.
    unit: Option<&'static str>,
    /// Number of values without a unit.
    without_unit: usize,
    /// Number of cells whose unit differs from that of the column, or that have none where others have.
    other_unit: usize,
    /// Number of cells that may be metres or thousandths, and the first of them.
    doubtful: usize,
    first_doubtful: String,
}

impl Cells {
    /// A column whose heading gives this unit.
    pub fn new(heading: Option<String>) -> Cells {
        Cells {
            values: Known::Nothing,
            missing: 0,
            bad: 0,
            first_bad: String::new(),
            heading,
            unit: None,
            without_unit: 0,
            other_unit: 0,
            doubtful: 0,
            first_doubtful: String::new(),
        }
    }

    pub fn push(&mut self, cell: &str, decimal: char) {
        // Nearly all cells are plain numbers.
        if let (Known::Numbers(numbers), '.', None) = (&mut self.values, decimal, self.unit)
            && let Some(number) = cell.parse().ok().filter(|number: &f64| !number.is_nan())
        {
            self.without_unit += 1;
            numbers.push(number);
            return;
        }
        match &mut self.values {
            Known::Numbers(_) => {
                let value = self.value(cell, decimal);
                if let Known::Numbers(numbers) = &mut self.values {
                    numbers.push(value);
                }
            }
            Known::Times(times) => {
                if !times.push(cell) && !is_missing(cell) {
                    self.is_bad(cell);
                }
            }
            Known::Nothing => self.first(cell, decimal),
        }
    }

    /// A cell before any value.
    fn first(&mut self, cell: &str, decimal: char) {
        if is_missing(cell) {
            self.missing += 1;
        } else if read(cell, decimal).is_some() {
            self.values = Known::Numbers(vec![f64::NAN; self.missing]);
            self.push(cell, decimal);
        } else if TimeText::of(cell).is_some() {
            self.values = Known::Times(TimeCells::after(self.missing));
            self.push(cell, decimal);
        } else {
            self.is_bad(cell);
            self.missing += 1;
        }
    }

    fn is_bad(&mut self, cell: &str) {
        self.bad += 1;
        if self.first_bad.is_empty() {
            self.first_bad = cell.chars().take(LONGEST_SHOWN).collect();
        }
    }

    /// The number in a cell; `NaN` if it is not a number, or its unit differs from that of the column.
    fn value(&mut self, cell: &str, decimal: char) -> f64 {
        let Some((number, suffix)) = read(cell, decimal) else {
            if !is_missing(cell) {
                self.is_bad(cell);
            }
            return f64::NAN;
        };
        let fits = match suffix {
            Suffix::Milli if self.heading.as_deref() == Some("m") => {
                self.doubtful += 1;
                if self.first_doubtful.is_empty() {
                    self.first_doubtful = cell.chars().take(LONGEST_SHOWN).collect();
                }
                return f64::NAN;
            }
            // Not a number, so no unit is missing.
            _ if number.is_nan() => true,
            Suffix::None | Suffix::Prefix | Suffix::Milli => {
                self.without_unit += 1;
                self.unit.is_none()
            }
            Suffix::Unit(unit) => match (&self.heading, self.unit) {
                (Some(heading), _) => heading == unit,
                (None, Some(own)) => own == unit,
                (None, None) if self.without_unit == 0 => {
                    self.unit = Some(unit);
                    true
                }
                (None, None) => false,
            },
        };
        self.other_unit += usize::from(!fits);
        if fits { number } else { f64::NAN }
    }

    /// Unit and values of the column with this name, and what it is if it has times; adds imperfections to `notes`.
    pub fn finish(self, name: &str, notes: &mut Vec<String>) -> (Option<String>, Values, Option<TimeKind>) {
        if self.bad > 0 {
            let (bad, first) = (self.bad, &self.first_bad);
            let what = if matches!(self.values, Known::Times(_)) { "time" } else { "number" };
            notes.push(format!(
                "column {name}: {bad} cells are no {what} and were taken as not measured; the first is \"{first}\""
            ));
        }
        let values = match self.values {
            Known::Nothing => Values::Numbers(vec![f64::NAN; self.missing]),
            Known::Numbers(numbers) => Values::Numbers(numbers),
            Known::Times(times) => {
                let (kind, values) = times.finish(name, notes);
                let unit = matches!(values, Values::Numbers(_)).then(|| "s".to_string());
                return (unit, values, Some(kind));
            }
        };
        let unit = self.heading.or(self.unit.map(str::to_string));
        if self.other_unit > 0 {
            let (count, than) = (self.other_unit, unit.as_deref().map_or("the others", |unit| unit));
            notes.push(format!(
                "column {name}: {count} cells have no unit or another than {than} and were taken as not measured"
            ));
        }
        if self.doubtful > 0 {
            let (count, cell) = (self.doubtful, &self.first_doubtful);
            let metres = cell.trim_end_matches('m');
            notes.push(format!(
                "column {name}: {count} cells like \"{cell}\" may be metres or thousandths and were taken as not measured; write \
                 \"{metres} m\", or numbers without m"
            ));
        }
        (unit, values, None)
    }
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_multiply_and_units_stay() {
        let unit = |name| Some(Suffix::Unit(name));
        for (cell, value, suffix) in [
            ("25.1m", 0.0251, Some(Suffix::Milli)),
            ("3.3k", 3300.0, Some(Suffix::Prefix)),
            ("1.2M", 1.2e6, Some(Suffix::Prefix)),
            ("470u", 470e-6, Some(Suffix::Prefix)),
            ("-4n", -4e-9, Some(Suffix::Prefix)),
            ("1e3k", 1e6, Some(Suffix::Prefix)),
            ("25.1mm", 25.1, unit("mm")),
            ("25.1 m", 25.1, unit("m")),
            ("3 bar", 3.0, unit("bar")),
            ("40%", 40.0, unit("%")),
            ("5°C", 5.0, unit("degC")),
            ("300K", 300.0, unit("K")),
            ("5", 5.0, Some(Suffix::None)),
        ] {
            let Some((number, found)) = read(cell, '.') else { panic!("{cell}") };
            assert!(
                (number - value).abs() <= 1e-15 * value.abs() && Some(found) == suffix,
                "{cell}: {number} {found:?}"
            );
        }
        assert_eq!(read("25,1k", ','), Some((25_100.0, Suffix::Prefix)));
    }

    #[test]
    fn what_is_no_number_with_a_unit_is_none() {
        for cell in [
            "", "m", "k", "5 k", "5 M", "5-", "5 1", "0x1F", "12:30:05", "1.2.3m", "5mpa", "abc", "5 apples", "-k",
            "e5m",
        ] {
            assert_eq!(read(cell, '.'), None, "{cell}");
        }
    }

    fn column(heading: Option<&str>, cells: &[&str]) -> (Option<String>, Vec<f64>, Vec<String>) {
        let mut column = Cells::new(heading.map(str::to_string));
        cells.iter().for_each(|cell| column.push(cell, '.'));
        let mut notes = Vec::new();
        match column.finish("x", &mut notes) {
            (unit, Values::Numbers(numbers), None) => (unit, numbers, notes),
            (_, other, _) => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_column_has_one_unit_or_none() {
        let bar = Some("bar".to_string());
        assert_eq!(column(None, &["", "3 bar", "4bar"]).0, bar);
        assert_eq!(column(None, &["3 bar", "4 bar"]).1, [3.0, 4.0]);
        assert_eq!(column(Some("bar"), &["3 bar", "4"]), (bar.clone(), vec![3.0, 4.0], vec![]));
        assert_eq!(column(None, &["5", "5m", "2k"]), (None, vec![5.0, 0.005, 2000.0], vec![]));
        let (unit, numbers, notes) = column(None, &["3 bar", "4", "500 mbar", "5k"]);
        assert_eq!((unit, numbers[0]), (bar, 3.0));
        assert!(numbers[1..].iter().all(|number| number.is_nan()) && notes[0].contains("3 cells"), "{notes:?}");
        let (unit, numbers, notes) = column(None, &["4", "3 bar"]);
        assert!(unit.is_none() && numbers[1].is_nan() && notes[0].contains("1 cells"), "{notes:?}");
        let (_, numbers, notes) = column(Some("m"), &["25.1m", "0.5"]);
        assert!(numbers[0].is_nan() && numbers[1] == 0.5 && notes[0].contains("\"25.1 m\""), "{notes:?}");
    }
}
