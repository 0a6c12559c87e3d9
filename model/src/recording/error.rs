//! Errors in a recording.

use thiserror::Error;

/// An inconsistent recording, or one that lacks a requested cylinder.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The number of values of a signal differs from the number of samples of the clock.
    #[error("signal {signal} has {found} values, but the clock has {expected} samples")]
    LengthMismatch {
        /// Contract name of the signal.
        signal: String,
        /// Number of values.
        found: usize,
        /// Number of samples of the clock.
        expected: usize,
    },
    /// Time does not increase, or is not a number.
    #[error("the clock does not increase at sample {index}: {previous} s, then {next} s")]
    ClockNotIncreasing {
        /// Index of the offending sample.
        index: usize,
        /// Time before it in s.
        previous: f64,
        /// Its time in s.
        next: f64,
    },
    /// There is no cylinder with that name.
    #[error("{source_name} has no cylinder \"{wanted}\"; it has {}", quoted_list(found))]
    UnknownCylinder {
        /// The recording's source.
        source_name: String,
        /// The requested name.
        wanted: String,
        /// The existing names.
        found: Vec<String>,
    },
}

fn quoted_list(names: &[String]) -> String {
    if names.is_empty() {
        return "none".to_string();
    }
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}
