//! Why there is no analysis.

use excavator_model::SignalError;

/// Why the energy of a recording could not be analysed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EnergyError {
    /// The recording does not give what the model needs.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// A signal without which no energy is known is not measured.
    #[error("{source_name} does not measure {signal}, without which the energy is unknown; record it, or give a map")]
    NotMeasured {
        /// The recording.
        source_name: String,
        /// Contract name.
        signal: String,
    },
    /// Nothing long enough to take a slope of.
    #[error("{source_name} has {samples} samples in {duration:.3} s and no stretch of {needed:.2} s without a gap")]
    TooShort {
        /// The recording.
        source_name: String,
        /// Samples.
        samples: usize,
        /// Length, s.
        duration: f64,
        /// Length that is needed, s.
        needed: f64,
    },
}
