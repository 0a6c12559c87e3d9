//! What can be wrong with a model, and between a model and a recording.

use crate::effects::UnknownEffect;

/// What can be wrong with a change to a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// No such effect in the catalogue.
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    /// The effect cannot sit there.
    #[error("effect {effect} cannot be added at \"{site}\" of {machine}: {reason}")]
    WrongSite {
        /// Effect name.
        effect: String,
        /// Where it was to go.
        site: String,
        /// The machine.
        machine: String,
        /// Why not.
        reason: String,
    },
    /// The model already has this effect there.
    #[error("{machine} already has {effect} at \"{site}\"")]
    AlreadyPresent {
        /// Effect name.
        effect: String,
        /// Where.
        site: String,
        /// The machine.
        machine: String,
    },
}

/// What can be wrong between a model and a recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// A signal that the model needs as input is nowhere in the recording.
    #[error("{source_name} does not measure {signal}, which {machine} needs as an input")]
    MissingInput {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The machine.
        machine: String,
    },
    /// The recording has no cylinder of a name that the machine has.
    #[error(transparent)]
    Recording(#[from] crate::recording::RecordingError),
    /// The initial state cannot be found.
    #[error("{source_name} has no initial value of {signal}: {reason}")]
    NoInitialState {
        /// The recording.
        source_name: String,
        /// The signal.
        signal: String,
        /// Why not.
        reason: String,
    },
}
