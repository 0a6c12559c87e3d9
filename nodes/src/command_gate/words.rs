//! Texts in the diagnostics part `commands`. The gate writes them and the dashboard parses them.

/// After the name of a valve: who commands it, or `-`.
pub(crate) const COMMANDED_BY: &str = ": commanded by";
/// After the name of a valve: age of its owner's last command, s, or `-`.
pub(crate) const COMMAND_AGE: &str = ": age of the last command [s]";
/// After the name of a valve: why it stays closed.
pub(crate) const CLOSED_BECAUSE: &str = ": closed because";
/// Before the name of the writer that has stopped the machine.
pub(crate) const STOPPED_BY: &str = "stopped by ";
