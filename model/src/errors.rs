//! Errors in changes to a model, and mismatches between a model and a recording.

use crate::effects::UnknownEffect;

/// An error in a change to a model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// The catalogue has no such effect.
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    /// The effect cannot act there.
    #[error("effect {effect} cannot be added at \"{site}\" of {machine}: {reason}")]
    WrongSite {
        /// Effect name.
        effect: String,
        /// The requested place.
        site: String,
        /// The machine.
        machine: String,
        /// The reason.
        reason: String,
    },
    /// A hook of the effect would never be called.
    #[error(
        "effect {effect} has the hook `{hook}`, which is never called, because its `{method}` is false: return true there"
    )]
    Unannounced {
        /// Effect name.
        effect: String,
        /// The hook of [`Physics`](crate::effects::Physics).
        hook: &'static str,
        /// The method that announces it.
        method: &'static str,
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

/// A mismatch between a model and a recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SignalError {
    /// The recording lacks a signal that the model needs as input.
    #[error("{source_name} does not measure {signal}, which {machine} needs as an input")]
    MissingInput {
        /// The recording.
        source_name: String,
        /// Contract name of the signal.
        signal: String,
        /// The machine.
        machine: String,
    },
    /// The recording lacks a cylinder of the machine.
    #[error(transparent)]
    Recording(#[from] crate::recording::RecordingError),
    /// The initial state cannot be determined.
    #[error("{source_name} has no initial value of {signal}: {reason}")]
    NoInitialState {
        /// The recording.
        source_name: String,
        /// The signal.
        signal: String,
        /// The reason.
        reason: String,
    },
}
