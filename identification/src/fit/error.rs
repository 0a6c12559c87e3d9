//! Why a fit fails.

use excavator_model::SignalError;
use excavator_model::simulation::SimulationError;

/// Why a fit failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FitError {
    /// The recordings lack signals that the model needs.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// The model cannot be simulated at the start values.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// No output of the model is measured.
    #[error("the recordings measure no output of {machine}; displacement or a pressure is needed")]
    NothingMeasured {
        /// The machine.
        machine: String,
    },
    /// No stretch of a recording is long enough.
    #[error("the recordings have no stretch of at least 20 samples without a gap that begins with a measured position")]
    TooShort,
    /// An effect acts in a window of time, and the recordings do not show where to search for it.
    #[error(
        "the time at which it acts cannot be found: the force balance needs signals that the recordings do not have"
    )]
    NoActiveWindow,
    /// The watch function stopped the fit.
    #[error("stopped on request")]
    Stopped,
}
