//! What can be wrong with a recording.

use thiserror::Error;

/// A recording that breaks its own promises or lacks what was asked of it.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// A signal has another number of values than the clock has samples.
    #[error("signal {signal} has {found} values, but the clock has {expected} samples")]
    LengthMismatch {
        /// Contract name of the signal.
        signal: String,
        /// Values that it has.
        found: usize,
        /// Samples of the clock.
        expected: usize,
    },
    /// Time stands still, jumps back, or is not a number.
    #[error("the clock does not increase at sample {index}: {previous} s, then {next} s")]
    ClockNotIncreasing {
        /// Index of the offending sample.
        index: usize,
        /// Time before it in s.
        previous: f64,
        /// Its time in s.
        next: f64,
    },
    /// No cylinder of that name.
    #[error("{source_name} has no cylinder \"{wanted}\"; it has {}", quoted_list(found))]
    UnknownCylinder {
        /// The recording's source.
        source_name: String,
        /// The name asked for.
        wanted: String,
        /// The names that exist.
        found: Vec<String>,
    },
}

fn quoted_list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_string();
    }
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}
