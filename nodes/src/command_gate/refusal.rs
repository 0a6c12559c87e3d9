//! Why a command is refused.

/// Why a command is refused. The message states what to do if that is not obvious.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub(crate) enum Refusal {
    /// The writer is not on the list of allowed writers.
    #[error("{writer} is not among the command_writers of this node")]
    NotAllowed {
        /// Node name or identity.
        writer: String,
    },
    /// The stamp is empty.
    #[error(
        "no stamp: set header.stamp to the time of sending (ros2 topic pub: \"header: auto\"), or set accept_unstamped"
    )]
    Unstamped,
    /// The command is too old by the clock of this node.
    #[error("stamped {age:.3} s ago, more than command_max_age = {most} s: are the clocks synchronised?")]
    TooOld {
        /// Age of the stamp, s.
        age: f64,
        /// Largest age that is allowed, s.
        most: f64,
    },
    /// The stamp is later than now.
    #[error("stamped {ahead:.3} s in the future, more than {most} s: are the clocks synchronised?")]
    FromTheFuture {
        /// Time from now to the stamp, s.
        ahead: f64,
        /// Largest time that is allowed, s.
        most: f64,
    },
    /// `names` and `areas` do not fit together.
    #[error("{names} names with {areas} areas")]
    Lengths {
        /// Number of names.
        names: usize,
        /// Number of areas.
        areas: usize,
    },
    /// No valve of this name.
    #[error("there is no cylinder \"{name}\" with a valve; there is {known}")]
    UnknownCylinder {
        /// The name.
        name: String,
        /// Names that exist.
        known: String,
    },
    /// The command names a valve twice.
    #[error("cylinder \"{name}\" is named twice")]
    Twice {
        /// The name.
        name: String,
    },
    /// An area is `NaN` or infinite.
    #[error("the area {area} m2 for \"{name}\" is not a number")]
    NotANumber {
        /// The cylinder.
        name: String,
        /// The area.
        area: f64,
    },
    /// An area exceeds the valve's area, or its limit.
    #[error("the area {area:.3e} m2 for \"{name}\" is beyond {maximum:.3e} m2")]
    OutOfRange {
        /// The cylinder.
        name: String,
        /// The area, m².
        area: f64,
        /// Largest area that may be commanded, m².
        maximum: f64,
    },
    /// The node waits to be activated, or ends.
    #[error("this node is not active")]
    NotActive,
    /// The machine is stopped.
    #[error("the machine is stopped by {by}")]
    Stopped {
        /// Who stopped it.
        by: String,
    },
    /// Another writer owns the valve.
    #[error("\"{name}\" is commanded by {owner}, whose lease is valid")]
    Owned {
        /// The cylinder.
        name: String,
        /// Who owns it.
        owner: String,
    },
    /// The valve was closed for safety, and requires an area of 0 first.
    #[error("\"{name}\" is closed because {reason}: command an area of 0 first")]
    NeutralFirst {
        /// The cylinder.
        name: String,
        /// Why it was closed.
        reason: String,
    },
}

impl Refusal {
    /// A short name of the kind of refusal. Commands refused for the same cause share it.
    pub fn kind(&self) -> &'static str {
        match self {
            Refusal::NotAllowed { .. } => "writer not allowed",
            Refusal::Unstamped => "unstamped",
            Refusal::TooOld { .. } => "too old",
            Refusal::FromTheFuture { .. } => "from the future",
            Refusal::Lengths { .. }
            | Refusal::UnknownCylinder { .. }
            | Refusal::Twice { .. }
            | Refusal::NotANumber { .. } => "malformed",
            Refusal::OutOfRange { .. } => "beyond the limit",
            Refusal::NotActive => "not active",
            Refusal::Stopped { .. } => "stopped",
            Refusal::Owned { .. } => "owned by another writer",
            Refusal::NeutralFirst { .. } => "neutral first",
        }
    }
}
