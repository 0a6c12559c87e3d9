//! Why a regression gives no numbers.

use excavator_model::SignalError;
use excavator_model::recording::Recording;

use crate::fit::FitError;

/// Why a regression gives no numbers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RegressionError {
    /// The recordings lack signals that the model needs.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// The simulation for the instruments failed.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// No equation has all its signals.
    #[error("{source_name}: no equation of {machine} has all its signals; {missing}")]
    NoEquation {
        /// The recordings.
        source_name: String,
        /// The machine.
        machine: String,
        /// What is not measured.
        missing: String,
    },
    /// Too little data for the number of parameters.
    #[error(
        "{source_name}: {rows} usable windows for {parameters} parameters; at least {needed} are needed, so record longer, \
         with motion"
    )]
    TooFewRows {
        /// The recordings.
        source_name: String,
        /// Usable rows.
        rows: usize,
        /// Parameters asked for.
        parameters: usize,
        /// Rows needed.
        needed: usize,
    },
    /// The data do not determine a combination of parameters.
    #[error("{source_name}: these recordings determine only a combination of these parameters: {}; vary speed, load and opening more, or mark one of them as known", names.join(", "))]
    NotIdentifiable {
        /// The recordings.
        source_name: String,
        /// Parameters that take part in the combination.
        names: Vec<String>,
    },
}

/// Names of recordings for a message.
pub(super) fn sources(recordings: &[&Recording]) -> String {
    recordings.iter().map(|recording| recording.source.as_str()).collect::<Vec<_>>().join(", ")
}
