//! Names and units of the columns of a text table, from its headings.

use super::layout::{Layout, unit_in};
use super::{TableFormat, cell, heading};
use crate::map::{Dimension, Unit};

/// One column before its values are read.
#[derive(Debug, PartialEq)]
pub(super) struct ColumnHeading {
    pub name: String,
    pub unit: Option<String>,
    /// Index of the column with its times, if it is not that of all others.
    pub times: Option<usize>,
}

/// The columns of a table before its values are read.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Headings {
    pub columns: Vec<ColumnHeading>,
    pub notes: Vec<String>,
}

/// Headings of a column of times, in lower case, which loggers repeat where each channel has its own times.
const TIMES: [&str; 8] = ["x_value", "x-value", "time", "t", "zeit", "timestamp", "time stamp", "elapsed time"];

impl Headings {
    /// The headings of `width` columns. Names in the map take precedence.
    pub fn of(layout: &Layout, width: usize, format: &TableFormat) -> Headings {
        let mut headings = Headings::default();
        for column in 0..width {
            let written = layout.names.get(column).map(String::as_str);
            let given = format.columns.get(column).map(String::as_str);
            let (name, mut unit) = heading::split(given.or(written).unwrap_or_default());
            let name = if name.is_empty() { format!("column_{}", column + 1) } else { name };
            if let Some(below) = layout.units.get(column).filter(|below| !below.is_empty()) {
                match unit_in(below) {
                    // Loggers write a dash, or NaN, where nobody gave a unit.
                    _ if cell::is_missing(below) => {}
                    Some(found) => unit = Some(found.name.to_string()),
                    None if column == 0 && layout.units.len() > 1 => {}
                    None => headings.unknown(&name, below),
                }
            } else if let Some(brackets) = heading::brackets(&name).filter(|_| unit.is_none()) {
                headings.unknown(&name, brackets);
            }
            // Some loggers write the unit of the times alone.
            let is_time = |found: &Unit| found.dimension == Dimension::Time && found.name.len() > 1;
            if column == 0 && unit.is_none() {
                unit = unit_in(&name).filter(is_time).map(|found| found.name.to_string());
            }
            headings.columns.push(ColumnHeading { name, unit, times: None });
        }
        headings.own_times(layout.has_own_times);
        headings
    }

    fn unknown(&mut self, name: &str, unit: &str) {
        self.notes.push(format!("column {name}: \"{unit}\" is no unit known here; give its unit in the map"));
    }

    /// Where headings of times are repeated, each column belongs to the times before it.
    fn own_times(&mut self, alternate: bool) {
        let is_time = |column: &ColumnHeading| TIMES.contains(&column.name.to_lowercase().as_str());
        let first = self.columns.first().filter(|first| is_time(first)).map(|first| first.name.clone());
        let places: Vec<usize> = match first {
            _ if alternate => (0..self.columns.len()).step_by(2).collect(),
            Some(first) => (0..self.columns.len()).filter(|place| self.columns[*place].name == first).collect(),
            None => Vec::new(),
        };
        if places.len() < 2 {
            return;
        }
        for place in 0..self.columns.len() {
            if !places.contains(&place) {
                self.columns[place].times = places.iter().copied().rfind(|times| *times < place);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Name, unit, index of the column of times.
    type Found = (String, Option<String>, Option<usize>);

    fn columns(names: &[&str], units: &[&str]) -> (Vec<Found>, usize) {
        let own = |texts: &[&str]| texts.iter().map(|text| text.to_string()).collect();
        let layout = Layout { names: own(names), units: own(units), ..Layout::default() };
        let found = Headings::of(&layout, names.len(), &TableFormat::default());
        (found.columns.into_iter().map(|column| (column.name, column.unit, column.times)).collect(), found.notes.len())
    }

    fn column(name: &str, unit: &str, times: Option<usize>) -> Found {
        (name.to_string(), Some(unit.to_string()).filter(|unit| !unit.is_empty()), times)
    }

    #[test]
    fn each_known_unit_is_taken_and_unknown_words_are_reported() {
        let (found, notes) = columns(&["Time", "x", "p", "F"], &["Sec", "mm", "furlong", ""]);
        let wanted = [column("Time", "s", None), column("x", "mm", None), column("p", "", None), column("F", "", None)];
        assert_eq!((found.as_slice(), notes), (&wanted[..], 1));
        let (found, _) = columns(&["ms", "Servo motor speed"], &[]);
        assert_eq!((found[0].1.as_deref(), found[1].1.as_deref()), (Some("ms"), None));
        let (found, notes) = columns(&["t [ms]", "p [furlong]"], &[]);
        assert_eq!((found[0].1.as_deref(), found[1].1.as_deref(), notes), (Some("ms"), None, 1));
    }

    #[test]
    fn repeated_times_belong_to_what_follows() {
        let (found, _) = columns(&["X_Value", "x", "X_Value", "p", "q"], &[]);
        assert_eq!(found.iter().map(|column| column.2).collect::<Vec<_>>(), [None, Some(0), None, Some(2), Some(2)]);
        assert!(columns(&["Time", "x", "p"], &[]).0.iter().all(|column| column.2.is_none()));
    }
}
