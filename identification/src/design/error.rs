//! Why a design fails.

use excavator_model::ModelError;
use excavator_model::SignalError;
use excavator_model::simulation::SimulationError;

use super::Violation;
use crate::fit::FitError;

/// Why no manoeuvre can be proposed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DesignError {
    /// A single rival: there is nothing to separate it from.
    #[error("{rival} alone has nothing to be told from; name a second effect, or \"none\", or a --parameter")]
    Alone {
        /// The only rival.
        rival: String,
    },
    /// The same rival twice.
    #[error("{rival} is named twice")]
    Twice {
        /// The rival.
        rival: String,
    },
    /// No cylinder has a valve that can be commanded.
    #[error("{machine} has no valve that could be commanded; its force is measured")]
    NoValve {
        /// The machine.
        machine: String,
    },
    /// Too short for a manoeuvre, or too long to be planned.
    #[error("a profile of {found} s cannot be designed; it must last {least} s to {most} s")]
    Duration {
        /// Duration asked for, s.
        found: f64,
        /// Shortest, s.
        least: f64,
        /// Longest, s.
        most: f64,
    },
    /// No such parameter.
    #[error("{machine} has no parameter \"{name}\"{}; it has {known}", meant(suggestion))]
    UnknownParameter {
        /// The machine.
        machine: String,
        /// Name asked for.
        name: String,
        /// The nearest name that exists.
        suggestion: Option<String>,
        /// Names of the unknown parameters.
        known: String,
    },
    /// The parameter is a known constant.
    #[error("{name} is a known constant of the model; nothing is to be found out about it")]
    KnownParameter {
        /// The parameter.
        name: String,
    },
    /// No manoeuvre of the library stays inside the limits.
    #[error("none of {tried} manoeuvres stays within the machine's limits; the last: {violation}")]
    OutsideLimits {
        /// Number of manoeuvres tried.
        tried: usize,
        /// The limit that the last one violates.
        violation: Violation,
    },
    /// An effect does not fit the model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A rival cannot be fitted.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// A rival lacks an input or a state at rest.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// A rival cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

fn meant(suggestion: &Option<String>) -> String {
    suggestion.as_ref().map_or(String::new(), |name| format!(" (did you mean \"{name}\"?)"))
}
