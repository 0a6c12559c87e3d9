//! Parses numbers in cells: plain, with an SI prefix (`3.3k`), or with a unit (`25.1 mm`); collects the cells of a
//! column.

use super::Values;
use super::dates::parse_date;
use crate::map::Unit;

/// SI prefixes that directly follow a number without a unit, and their factors. K is the kelvin.
const PREFIXES: [(&str, f64); 9] =
    [("G", 1e9), ("M", 1e6), ("k", 1e3), ("m", 1e-3), ("u", 1e-6), ("µ", 1e-6), ("μ", 1e-6), ("n", 1e-9), ("p", 1e-12)];

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
fn unit(name: &str) -> Option<&'static str> {
    let found = Unit::named(name)?.name;
    let initial = |text: &str| text.chars().next();
    let other_case = initial(name).zip(initial(found)).is_some_and(|(a, b)| a != b && a.eq_ignore_ascii_case(&b));
    let changes_meaning = other_case && (name.len() == 1 || name.starts_with(['m', 'M']));
    (!["1", "-"].contains(&found) && !changes_meaning).then_some(found)
}

/// Length in bytes of the number at the start of a text: sign, digits and separators, exponent.
fn end_of_number(text: &str) -> usize {
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

/// The number in a cell without a suffix.
pub(super) fn number(cell: &str, decimal: char) -> Option<f64> {
    let cell = cell.trim();
    if decimal == '.' {
        return cell.parse().ok();
    }
    // With a decimal comma, a point separates thousands.
    cell.replace('.', "").replace(',', ".").parse().ok()
}

/// Whether a cell marks a missing value.
pub(super) fn is_missing(cell: &str) -> bool {
    let cell = cell.trim();
    cell.is_empty() || ["nan", "na", "n/a", "null", "none", "-", "--"].contains(&cell.to_lowercase().as_str())
}

/// The values of one column read so far.
#[derive(Default)]
pub(super) struct Cells {
    /// `None` before the first cell that is not empty: that cell decides whether the column contains dates.
    values: Option<Values>,
    /// Number of empty cells before the first value.
    missing: usize,
    /// Number of cells that are neither a number nor empty.
    bad: usize,
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
        Cells { heading, ..Cells::default() }
    }

    pub fn push(&mut self, cell: &str, decimal: char) {
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
        if let Some(Values::Stamps(stamps)) = &mut self.values {
            let stamp = parse_date(cell);
            self.bad += usize::from(stamp.is_none() && !is_missing(cell));
            stamps.push(stamp);
            return;
        }
        let value = self.value(cell, decimal);
        if let Some(Values::Numbers(numbers)) = &mut self.values {
            numbers.push(value);
        }
    }

    /// The number in a cell; `NaN` if it is not a number, or its unit differs from that of the column.
    fn value(&mut self, cell: &str, decimal: char) -> f64 {
        let Some((number, suffix)) = read(cell, decimal) else {
            self.bad += usize::from(!is_missing(cell));
            return f64::NAN;
        };
        let fits = match suffix {
            Suffix::Milli if self.heading.as_deref() == Some("m") => {
                self.doubtful += 1;
                if self.first_doubtful.is_empty() {
                    self.first_doubtful = cell.chars().take(20).collect();
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

    /// Unit and values of the column with this name; adds imperfections to `notes`.
    pub fn finish(self, name: &str, notes: &mut Vec<String>) -> (Option<String>, Values) {
        if self.bad > 0 {
            let bad = self.bad;
            notes.push(format!("column {name}: {bad} cells are no number and were taken as not measured"));
        }
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
        (unit, self.values.unwrap_or_else(|| Values::Numbers(vec![f64::NAN; self.missing])))
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
            (unit, Values::Numbers(numbers)) => (unit, numbers, notes),
            (_, other) => panic!("{other:?}"),
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
