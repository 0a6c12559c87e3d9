//! How much the program says.

use std::sync::OnceLock;

/// What `--quiet` and `--verbose` choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Verbosity {
    /// Errors, and files that were asked for.
    Quiet,
    /// The result: a sentence, a table, the next command.
    #[default]
    Normal,
    /// The technical detail behind it as well.
    Verbose,
}

static CHOSEN: OnceLock<Verbosity> = OnceLock::new();

impl Verbosity {
    /// Chooses it for the whole process; the first choice stays.
    pub fn choose(self) {
        let _ = CHOSEN.set(self);
    }

    /// What was chosen.
    pub fn chosen() -> Self {
        CHOSEN.get().copied().unwrap_or_default()
    }
}
