//! A column or field that may be a signal.

use rosbag2::dynamic::FieldPath;

use super::super::clock_source::{ClockSource, ColumnName};
use super::super::signal::SignalName;
use super::super::signal_source::SignalSource;
use super::super::unit::{Dimension, Unit};

/// Source of the numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Origin {
    /// By its heading, and by its number from 1 where another column has the same.
    Column {
        name: String,
        number: Option<usize>,
    },
    Field {
        topic: String,
        field: FieldPath,
    },
}

/// A column or field with its values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Candidate {
    pub origin: Origin,
    /// Lower-case words of its name.
    pub words: Vec<String>,
    /// Unit from a heading or from the message type, and its source.
    pub unit: Option<(Unit, String)>,
    /// Dimension from the message type.
    pub dimension: Option<Dimension>,
    /// s.
    pub time: Vec<f64>,
    pub values: Vec<f64>,
    /// Share of the cells or messages that have a value.
    pub filled: f64,
}

/// The candidates found in data.
pub(super) struct Found {
    pub candidates: Vec<Candidate>,
    /// The clock and the reason for it.
    pub clock: (ClockSource, String),
    /// What cannot be read without more information, and which information.
    pub unreadable: Vec<String>,
}

impl Candidate {
    /// Its name for display.
    pub fn label(&self) -> String {
        match &self.origin {
            Origin::Column { name, number: None } => name.clone(),
            Origin::Column { name, number: Some(number) } => format!("{name} (column {number})"),
            Origin::Field { topic, field } => format!("{topic} {field}"),
        }
    }

    /// Its entry in a map.
    pub fn source(&self, signal: SignalName, unit: Option<&str>) -> SignalSource {
        let mut source = SignalSource::new(signal);
        match &self.origin {
            Origin::Column { name, number } => {
                source.column = Some(number.map_or_else(|| ColumnName::Name(name.clone()), ColumnName::Number));
            }
            Origin::Field { topic, field } => {
                source.topic = Some(topic.clone());
                source.field = Some(field.clone());
            }
        }
        source.unit = unit.map(str::to_string);
        source
    }
}

/// Lower-case words of a name: split at special characters, at changes from lower to upper case, and between letters
/// and digits.
pub(super) fn words(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    for character in name.chars() {
        let starts = (character.is_uppercase() && before.is_lowercase())
            || character.is_ascii_digit() != before.is_ascii_digit()
            || !before.is_alphanumeric();
        if character.is_alphanumeric() {
            match words.last_mut() {
                Some(word) if !starts => word.extend(character.to_lowercase()),
                _ => words.push(character.to_lowercase().collect()),
            }
        } else if character == '+' {
            words.push("plus".to_string());
        }
        before = character;
    }
    words
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn names_fall_apart_where_people_read_a_gap() {
        assert_eq!(words("/armCylinder/p_A2"), ["arm", "cylinder", "p", "a", "2"]);
        assert_eq!(words("position[name=arm]"), ["position", "name", "arm"]);
        assert_eq!(words("pA"), ["p", "a"]);
        assert_eq!(words("Druck p+"), ["druck", "p", "plus"]);
    }
}
