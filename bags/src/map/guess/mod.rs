//! Guessing a map: from names, types, units, and the shapes of the signals. A guess is for people to confirm.

mod candidate;
mod choose;
mod from_bag;
mod from_table;
mod names;
mod shapes;
mod text;

use std::path::Path;

use super::document::{ClockSource, SignalSource, TopicMap};
use crate::BagError;
use crate::table::{Table, TableFormat};

/// One guessed signal and why.
#[derive(Debug, Clone, PartialEq)]
pub struct GuessedSignal {
    /// As it stands in the map.
    pub source: SignalSource,
    /// Why this source is this signal.
    pub reason: String,
    /// Why it has this unit.
    pub unit_reason: String,
}

/// A guessed map.
#[derive(Debug, Clone, PartialEq)]
pub struct Guess {
    /// The data.
    pub data: String,
    /// The clock and why.
    pub clock: (ClockSource, String),
    /// The signals, best founded first.
    pub signals: Vec<GuessedSignal>,
    /// Columns and fields that are no signal as far as can be told.
    pub left: Vec<String>,
}

impl Guess {
    /// The guess as a map.
    pub fn map(&self) -> TopicMap {
        TopicMap {
            description: format!("guessed from {}: check every line", self.data),
            clock: self.clock.0.clone(),
            signals: self.signals.iter().map(|guessed| guessed.source.clone()).collect(),
            ..TopicMap::default()
        }
    }
}

/// Guesses which signals the bag or table at `path` has. `cylinder` is the one that signals belong to whose names do
/// not say.
///
/// # Errors
/// When the data cannot be read: those of [`RawMessages::open`](crate::RawMessages::open), [`BagError::BadTable`].
pub fn guess(path: &Path, cylinder: &str) -> Result<Guess, BagError> {
    let (candidates, clock) = if Table::is_table(path) {
        from_table::candidates(&Table::read(path, &TableFormat::default())?)
    } else {
        from_bag::candidates(path)?
    };
    let (signals, left) = choose::choose(candidates, cylinder);
    Ok(Guess { data: path.display().to_string(), clock, signals, left })
}

/// The clock of a table and why.
pub(crate) fn clock_of_table(table: &Table) -> (ClockSource, String) {
    from_table::candidates(table).1
}
