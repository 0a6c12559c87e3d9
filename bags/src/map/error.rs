//! Errors in a topic map.

use std::path::PathBuf;

use excavator_model::document::TomlFault;
use excavator_model::formula::FormulaError;
use rosbag2::dynamic::{LayoutError, PathError};
use thiserror::Error;

use super::unit::Dimension;

/// A topic map that is invalid, or does not fit the data.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MapError {
    /// Text that is not a map.
    #[error("the map is not understood: {}", _0.message)]
    Syntax(TomlFault),
    /// The map in a file is wrong.
    #[error("{}: {source}", path.display())]
    InFile {
        /// The file.
        path: PathBuf,
        /// The fault.
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
    /// A signal to be left out that does not exist.
    #[error("[[leave_out]] names {signal}, which the map does not have")]
    LeavesNothingOut {
        /// The signal.
        signal: String,
    },
    /// The same signal twice.
    #[error("{signal} is mapped twice")]
    SignalTwice {
        /// The signal.
        signal: String,
    },
    /// Not exactly one source.
    #[error("{signal}: give either `topic` and `field`, or `column`, or `formula`, or `value`")]
    NoSource {
        /// The signal.
        signal: String,
    },
    /// A name without a source, or with two.
    #[error("{place}: give either a `column`, or `topic` and `field`")]
    NoPlace {
        /// The name.
        place: String,
    },
    /// A name that cannot be written in a formula.
    #[error("[names] \"{name}\" is no name: write it with letters, digits and _, as in p_hi")]
    BadName {
        /// The name.
        name: String,
    },
    /// A key that specifies details of something that is not given.
    #[error("{place}: `{key}` needs {wanted}")]
    KeyWithout {
        /// The signal, name or file.
        place: String,
        /// The key.
        key: &'static str,
        /// What it requires.
        wanted: &'static str,
    },
    /// A formula that cannot be used.
    #[error("{signal}: formula: {source}; it may use {}", known.join(", "))]
    Formula {
        /// The signal.
        signal: String,
        /// The fault and its location.
        source: Box<FormulaError>,
        /// The first few available names.
        known: Vec<String>,
    },
    /// Data without any signal of the built-in map `opera`.
    #[error(
        "{}: no frame of COM3 and no topic with joints or pressures of OPERA; there are {}",
        path.display(),
        if topics.is_empty() { "no topics".to_string() } else { topics.join(", ") }
    )]
    NoOpera {
        /// The data.
        path: PathBuf,
        /// The topics that exist.
        topics: Vec<String>,
    },
    /// A signal of a CAN frame in a map without DBC file.
    #[error("{place}: a `message` needs a DBC file: put `dbc = \"FILE.dbc\"` at the top of the map")]
    NoDbc {
        /// The signal or name.
        place: String,
    },
    /// A DBC file that is invalid, or lacks what the map refers to.
    #[error("{place}: {reason}")]
    Dbc {
        /// The signal, name or file.
        place: String,
        /// The fault.
        reason: String,
    },
    /// A message of the DBC file on a topic without frames.
    #[error("{place}: topic {topic} carries {type_name}, not CAN frames; leave `message` out")]
    NoFrames {
        /// The signal or name.
        place: String,
        /// The topic.
        topic: String,
        /// Type of its messages.
        type_name: String,
    },
    /// A file that the map does not join.
    #[error("{place}: {} is not joined; the map joins {}", file.display(), listed(joined))]
    NotJoined {
        /// The signal or name.
        place: String,
        /// The requested file.
        file: PathBuf,
        /// The joined files.
        joined: Vec<PathBuf>,
    },
    /// A heading that occurs in several joined files.
    #[error("{place}: column \"{column}\" is in {}; say which with `file`", listed(files))]
    Ambiguous {
        /// The signal or name.
        place: String,
        /// The heading.
        column: String,
        /// The files.
        files: Vec<PathBuf>,
    },
    /// Only one of two files contains dates.
    #[error(
        "{} and the data cannot be joined, because only {} has dates; give [[join]] `offset`, the time in s from the first row of \
         the data to the first row of the file",
        file.display(),
        if *is_dated { "the file" } else { "the data" }
    )]
    OneIsUndated {
        /// The joined file.
        file: PathBuf,
        /// Whether the joined file has dates.
        is_dated: bool,
    },
    /// Files whose times do not overlap.
    #[error(
        "{} has no time in common with the data: it is from {from:.3} s to {to:.3} s, the data from 0 s to {duration:.3} s; give \
         [[join]] `offset`",
        file.display()
    )]
    Apart {
        /// The joined file.
        file: PathBuf,
        /// Its first row, s after the first of the data.
        from: f64,
        /// Its last row, s after the first of the data.
        to: f64,
        /// Length of the data, s.
        duration: f64,
    },
    /// Two consecutive files whose times overlap.
    #[error(
        "{} and {} overlap by {overlap:.3} s, so they are not consecutive pieces of one recording; if they were recorded at the same time, join one to the other with --join",
        first.display(),
        second.display()
    )]
    PiecesOverlap {
        /// The file that begins first.
        first: PathBuf,
        /// The next.
        second: PathBuf,
        /// Overlap, s.
        overlap: f64,
    },
    /// Joined tables with several data files.
    #[error("--join goes with one file, not with {pieces}: import each of them with its table, then the bags together")]
    JoinsOfPieces {
        /// Number of data files.
        pieces: usize,
    },
    /// A joined table without a map that assigns its columns.
    #[error("{} has columns, but no map says which signals they are; give one with --map", file.display())]
    JoinWithoutMap {
        /// The joined file.
        file: PathBuf,
    },
    /// An unknown unit.
    #[error("{signal}: \"{unit}\" is no unit known here; known are {known}")]
    UnknownUnit {
        /// The signal.
        signal: String,
        /// The unit as written.
        unit: String,
        /// All units.
        known: String,
    },
    /// A unit whose dimension differs from that of the signal.
    #[error("{signal} is a {wanted}, but {unit} is a {found}: give `scale`, like \"25 {}/{unit}\"", wanted.si_unit())]
    WrongDimension {
        /// The signal.
        signal: String,
        /// Dimension of the signal.
        wanted: Dimension,
        /// The unit.
        unit: String,
        /// Dimension of the unit.
        found: Dimension,
    },
    /// A number with a unit that cannot be parsed.
    #[error("{signal}: \"{text}\" in `{key}` is not understood; write a number in SI units or like \"{example}\"")]
    BadQuantity {
        /// The signal.
        signal: String,
        /// `scale`, `offset` or `value`.
        key: &'static str,
        /// As written.
        text: String,
        /// A valid example.
        example: &'static str,
    },
    /// A number outside the valid range.
    #[error("{place}: `{key}` = {found} must be {wanted}")]
    BadNumber {
        /// The signal, or "clock".
        place: String,
        /// The key.
        key: &'static str,
        /// The value found.
        found: f64,
        /// The valid values.
        wanted: &'static str,
    },
    /// A field path that the type of the topic does not have.
    #[error("{signal}, topic {topic}: {source}")]
    Field {
        /// The signal.
        signal: String,
        /// The topic.
        topic: String,
        /// The fault in the path.
        source: PathError,
    },
    /// A topic whose type is unknown.
    #[error("topic {topic}: {source}")]
    Layout {
        /// The topic.
        topic: String,
        /// The fault in the definition.
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
    /// A time that cannot be parsed.
    #[error("[clock] start = \"{text}\" is not understood: {reason}; write it like 2026-05-01T12:00:00Z")]
    BadStart {
        /// As written.
        text: String,
        /// The fault.
        reason: String,
    },
    /// Stamps that run faster or slower than the log times of the other topics.
    #[error(
        "stamps in the headers of {topic} run at {rate:.3} s per second of the log times, and {others} have only log times: as in a \
         simulation that is not real time; record with use_sim_time, or give stamp = \"log\" for the signals of {topic} to take the recorder's seconds"
    )]
    ClockRates {
        /// The topic with the stamps.
        topic: String,
        /// Seconds of its stamps per second of the log.
        rate: f64,
        /// The topics without.
        others: String,
    },
    /// A signal that has no time in common with the clock.
    #[error(
        "{signal} has no time in common with the clock ({clock}): its values are from {stretch} after the start of the clock, which has \
         {duration:.3} s: the two are stamped by different clocks; give stamp = \"log\" for both"
    )]
    NoCommonTime {
        /// The signal.
        signal: String,
        /// Topic of the clock.
        clock: String,
        /// First and last value, relative to the first sample of the clock.
        stretch: String,
        /// Length of the clock, s.
        duration: f64,
    },
    /// A column of times without a time.
    #[error("{}: the clock (column {column}) has no time{}; times are {}", path.display(), because(example), crate::table::TIME_FORMS)]
    NoTimes {
        /// The data.
        path: PathBuf,
        /// The column.
        column: String,
        /// What was found in it, if anything.
        example: Option<String>,
    },
    /// A clock without samples.
    #[error("{}: the clock ({clock}) has no sample", path.display())]
    EmptyClock {
        /// The data.
        path: PathBuf,
        /// Topic or column.
        clock: String,
    },
}

fn because(found: &Option<String>) -> String {
    found.as_ref().map_or(String::new(), |found| format!(": {found}"))
}

fn listed(files: &[PathBuf]) -> String {
    let names: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
    if names.is_empty() { "no file".to_string() } else { names.join(", ") }
}

impl MapError {
    /// The faulty line of the map with a mark at the location; empty if there is none. Intended for the owner of the
    /// file.
    pub fn excerpt(&self) -> &str {
        match self {
            MapError::Syntax(fault) => &fault.excerpt,
            MapError::InFile { source, .. } => source.excerpt(),
            _ => "",
        }
    }
}
