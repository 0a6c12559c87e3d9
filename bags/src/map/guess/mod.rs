//! Guesses a map from names, types, units, and the shapes of the signals. The user must confirm a guess.

mod candidate;
mod choose;
mod confidence;
mod from_bag;
mod from_table;
mod names;
mod pair;
mod shapes;
mod sheet_column;
mod text;

use std::collections::BTreeMap;
use std::path::Path;

use excavator_model::machine::{Cylinder, Drive, Machine};

use self::candidate::Found;
pub use self::sheet_column::{SheetColumn, ZeroAt};
use super::clock_source::ClockSource;
use super::document::TopicMap;
use super::fault_code;
use super::signal_source::SignalSource;
use super::unit::{Dimension, Unit};
use crate::BagError;
use crate::table::{Table, TableFormat};

/// Confidence in a guess.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Confidence {
    /// Something else is nearly as likely, or only order and size support it.
    Unsure,
    /// Nothing contradicts it, but there is little evidence; or its unit follows only from the size of its numbers.
    Likely,
    /// Name, unit or shape support it, and nothing else.
    Sure,
    /// Chosen by the user.
    Chosen,
}

impl Confidence {
    /// The name in one word.
    pub fn name(self) -> &'static str {
        match self {
            Confidence::Unsure => "unsure",
            Confidence::Likely => "likely",
            Confidence::Sure => "sure",
            Confidence::Chosen => "chosen",
        }
    }
}

/// Information that is known before the data are examined.
#[derive(Debug, Clone, Copy)]
pub struct Hints<'h> {
    /// The cylinder of signals whose names do not contain one.
    pub cylinder: &'h str,
    /// The machine, with the strokes of its cylinders and the inputs of their drives.
    pub machine: Option<&'h Machine>,
    /// What the owner says of columns, by heading.
    pub columns: &'h BTreeMap<String, SheetColumn>,
}

/// For a table that nobody describes.
pub static NO_COLUMNS: BTreeMap<String, SheetColumn> = BTreeMap::new();

impl<'h> From<&'h str> for Hints<'h> {
    /// Only the name of a cylinder is known.
    fn from(cylinder: &'h str) -> Self {
        Hints { cylinder, machine: None, columns: &NO_COLUMNS }
    }
}

impl Hints<'_> {
    fn known(&self, name: Option<&String>) -> Option<&Cylinder> {
        let cylinders = &self.machine?.cylinders;
        cylinders.iter().find(|cylinder| Some(&cylinder.name) == name)
    }

    /// Stroke of a cylinder, m; `None` for a motor.
    fn stroke(&self, name: Option<&String>) -> Option<f64> {
        self.known(name).filter(|cylinder| !cylinder.is_motor()).map(|cylinder| cylinder.stroke)
    }

    /// Dimension of the input of its drive.
    fn input(&self, name: Option<&String>) -> Option<Dimension> {
        Some(Dimension::of_command(self.known(name)?.chambers?.drive.command_unit()))
    }

    /// Whether the machine may have a cylinder of this name: any, if the machine is not known.
    fn may_have_cylinder(&self, name: &str) -> bool {
        self.machine.is_none_or(|machine| machine.cylinders.iter().any(|cylinder| cylinder.name == name))
    }

    /// Whether one of its drives rotates.
    fn has_motor(&self) -> bool {
        self.machine.is_some_and(|machine| machine.cylinders.iter().any(Cylinder::is_motor))
    }

    /// Whether a pump of its own drives a cylinder: its speed is the input.
    fn has_pump_drive(&self) -> bool {
        let drives = self.machine.into_iter().flat_map(|machine| &machine.cylinders).filter_map(|one| one.chambers);
        drives.into_iter().any(|chambers| matches!(chambers.drive, Drive::Pump { .. }))
    }
}

/// A column or field that may be a signal.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Possibility {
    /// Its map entry.
    pub source: SignalSource,
    /// Name of the column or field for display.
    pub label: String,
    /// Reason for the assignment.
    pub reason: String,
    /// Reason for the unit.
    pub unit_reason: String,
    /// Whether the scale of its entry is a placeholder: nothing in the data says what the sensor or the valve makes of its unit.
    pub needs_scale: bool,
}

/// One guessed signal and the reasons for it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct GuessedSignal {
    /// Its map entry.
    pub source: SignalSource,
    /// Name of the column or field for display.
    pub label: String,
    /// Reason for the assignment.
    pub reason: String,
    /// Reason for the unit.
    pub unit_reason: String,
    /// Whether the scale of its entry is a placeholder.
    pub needs_scale: bool,
    /// Confidence in the assignment.
    pub confidence: Confidence,
    /// Other possible sources, if it is not sure.
    pub alternatives: Vec<Possibility>,
}

/// A guessed map.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Guess {
    /// The data.
    pub data: String,
    /// The clock and the reason for it.
    pub clock: (ClockSource, String),
    /// The signals, in the order of the messages.
    pub signals: Vec<GuessedSignal>,
    /// Columns and fields that do not appear to be signals.
    pub left: Vec<String>,
}

impl Guess {
    /// The guess as a map, without unsure signals and without scales that are placeholders: who reads with it is asked for them.
    pub fn map(&self) -> TopicMap {
        let taken = self.signals.iter().filter(|guessed| guessed.confidence > Confidence::Unsure);
        TopicMap {
            description: format!("guessed from {}: check every line", self.data),
            clock: self.clock.0.clone(),
            signals: taken.map(GuessedSignal::without_placeholder).collect(),
            ..TopicMap::default()
        }
    }

    /// Sets the user's choice of source for a signal: 0 is the guessed one, 1 the first alternative. It is removed from
    /// all other unsure signals.
    pub fn choose(&mut self, signal: usize, choice: usize) {
        let Some(guessed) = self.signals.get_mut(signal) else { return };
        let before = guessed.label.clone();
        if let Some(number) = choice.checked_sub(1) {
            if number >= guessed.alternatives.len() {
                return;
            }
            guessed.take(number);
        }
        guessed.confidence = Confidence::Chosen;
        guessed.alternatives.clear();
        let label = guessed.label.clone();
        for other in self.signals.iter_mut().filter(|other| other.confidence == Confidence::Unsure) {
            other.alternatives.retain(|alternative| alternative.label != label);
            if other.label == label && !other.alternatives.is_empty() {
                other.take(0);
            }
        }
        self.signals.retain(|other| other.confidence > Confidence::Unsure || other.label != label);
        self.left.retain(|left| *left != label);
        if self.signals.iter().all(|other| other.label != before) {
            self.left.push(before);
        }
    }
}

impl GuessedSignal {
    /// Its map entry without a scale that is a placeholder.
    fn without_placeholder(&self) -> SignalSource {
        let mut source = self.source.clone();
        source.scale = source.scale.filter(|_| !self.needs_scale);
        source
    }

    /// Makes an alternative the guess.
    fn take(&mut self, number: usize) {
        let Possibility { source, label, reason, unit_reason, needs_scale } = self.alternatives.remove(number);
        (self.source, self.label, self.reason, self.unit_reason) = (source, label, reason, unit_reason);
        self.needs_scale = needs_scale;
    }
}

/// Guesses which signals the bag or table at `path` has. Signals whose names do not contain a cylinder belong to
/// `cylinder`.
///
/// ```no_run
/// use std::path::Path;
///
/// let guess = excavator_bags::map::guess(Path::new("pressures.csv"), "arm")?;
/// for signal in &guess.signals {
///     println!("{} is {}: {} ({})", signal.source.signal, signal.label, signal.reason, signal.confidence.name());
/// }
/// std::fs::write("pressures.csv.map.toml", guess.map().to_text()?)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the data cannot be read: the errors of [`RawMessages::open`](rosbag2::RawMessages::open), [`BagError::BadTable`].
pub fn guess<'h>(path: &Path, hints: impl Into<Hints<'h>>) -> Result<Guess, BagError> {
    let Found { mut candidates, clock, unreadable } = if Table::is_table(path) {
        from_table::candidates(&Table::read(path, &TableFormat::default())?)
    } else {
        from_bag::candidates(path)?
    };
    for candidate in &mut candidates {
        // A code of -999 is no extreme of a position.
        fault_code::remove_from(&mut candidate.values);
    }
    let (signals, mut left) = choose::choose(candidates, hints.into());
    left.extend(unreadable);
    Ok(Guess { data: path.display().to_string(), clock, signals, left })
}

/// A column of a table with its clock.
#[derive(Debug, Clone, PartialEq)]
pub struct TimedColumn {
    /// Heading.
    pub name: String,
    /// Unit in the heading.
    pub unit: Option<Unit>,
    /// Times, s.
    pub time: Vec<f64>,
    /// Values, in the unit.
    pub values: Vec<f64>,
}

/// The columns of a table besides its clock, in order.
pub fn timed_columns(table: &Table) -> Vec<TimedColumn> {
    let found = from_table::candidates(table).candidates.into_iter();
    let column = |one: candidate::Candidate| TimedColumn {
        name: one.label(),
        unit: one.unit.map(|(unit, _)| unit),
        time: one.time,
        values: one.values,
    };
    found.map(column).collect()
}

/// The clock of a table and the reason for it.
pub(crate) fn clock_of_table(table: &Table) -> (ClockSource, String) {
    from_table::candidates(table).clock
}
