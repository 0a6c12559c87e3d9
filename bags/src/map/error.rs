//! What can be wrong with a topic map.

use std::path::PathBuf;

use thiserror::Error;

use super::unit::Dimension;
use crate::dynamic::{LayoutError, PathError};

/// A topic map that cannot be used, or does not fit the data.
#[derive(Debug, Error)]
pub enum MapError {
    /// No map in the text.
    #[error("the map is not understood: {0}")]
    Syntax(String),
    /// The map in a file is wrong.
    #[error("{}: {source}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: Box<MapError>,
    },
    /// A map without signals.
    #[error("the map has no [[signals]]: nothing would be read")]
    NoSignals,
    /// A signal that a recording does not have.
    #[error("there is no signal \"{wanted}\"; signals are CYLINDER.{} and {}", cylinder.join(", CYLINDER."), shared.join(", "))]
    UnknownSignal {
        /// The name in the map.
        wanted: String,
        /// Signals of a cylinder.
        cylinder: Vec<&'static str>,
        /// Signals of the machine.
        shared: Vec<&'static str>,
    },
    /// The same signal twice.
    #[error("{signal} is mapped twice")]
    SignalTwice {
        /// The signal.
        signal: String,
    },
    /// Not exactly one source.
    #[error("{signal}: give either `topic` and `field`, or `column`, or `value`")]
    NoSource {
        /// The signal.
        signal: String,
    },
    /// A unit without meaning.
    #[error("{signal}: \"{unit}\" is no unit known here; known are {known}")]
    UnknownUnit {
        /// The signal.
        signal: String,
        /// The unit as written.
        unit: String,
        /// All units.
        known: String,
    },
    /// A unit of another kind than the signal.
    #[error("{signal} is a {wanted}, but {unit} is a {found}: give `scale`, like \"25 {}/{unit}\"", wanted.si_unit())]
    WrongDimension {
        /// The signal.
        signal: String,
        /// What the signal is.
        wanted: Dimension,
        /// The unit.
        unit: String,
        /// What the unit measures.
        found: Dimension,
    },
    /// A number with unit that is none.
    #[error("{signal}: \"{text}\" in `{key}` is not understood; write a number in SI units or like \"{example}\"")]
    BadQuantity {
        /// The signal.
        signal: String,
        /// `scale`, `offset` or `value`.
        key: &'static str,
        /// As written.
        text: String,
        /// What would do.
        example: &'static str,
    },
    /// A number outside what makes sense.
    #[error("{place}: `{key}` = {found} must be {wanted}")]
    BadNumber {
        /// The signal, or "clock".
        place: String,
        /// The key.
        key: &'static str,
        /// What is there.
        found: f64,
        /// What may be there.
        wanted: &'static str,
    },
    /// A field path that the type of the topic does not have.
    #[error("{signal}, topic {topic}: {source}")]
    Field {
        /// The signal.
        signal: String,
        /// The topic.
        topic: String,
        /// What is wrong with the path.
        source: PathError,
    },
    /// A topic whose type is not known.
    #[error("topic {topic}: {source}")]
    Layout {
        /// The topic.
        topic: String,
        /// What is wrong with the definition.
        source: LayoutError,
    },
    /// A map of columns for a bag, or of topics for a table.
    #[error("{signal} is taken from a {found}, but {} is a {wanted}", path.display())]
    WrongSource {
        /// The signal, or "the clock".
        signal: String,
        /// "topic" or "column".
        found: &'static str,
        /// The data.
        path: PathBuf,
        /// "bag" or "table".
        wanted: &'static str,
    },
    /// No such column.
    #[error("there is no column \"{wanted}\"; the table has {}", existing.join(", "))]
    NoColumn {
        /// The column.
        wanted: String,
        /// All columns.
        existing: Vec<String>,
    },
    /// Columns of different lengths.
    #[error("column {column} has {found} rows, but the clock has {expected}")]
    ColumnLength {
        /// The column.
        column: String,
        /// Its rows.
        found: usize,
        /// Rows of the clock.
        expected: usize,
    },
    /// A table without time.
    #[error("the map does not say when rows were taken: give [clock] `column`, or `rate` in samples per second")]
    NoClock,
    /// A time that is none.
    #[error("[clock] start = \"{text}\" is not understood: {reason}; write it like 2026-05-01T12:00:00Z")]
    BadStart {
        /// As written.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Nothing with a time.
    #[error("{}: the clock ({clock}) has no sample", path.display())]
    EmptyClock {
        /// The data.
        path: PathBuf,
        /// Topic or column.
        clock: String,
    },
}
