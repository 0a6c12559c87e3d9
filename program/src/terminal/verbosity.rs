//! How much output the program prints.

use std::sync::OnceLock;

/// What `--quiet` and `--verbose` choose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Verbosity {
    /// Errors, and files that were requested.
    Quiet,
    /// The result: a sentence, a table, the next command.
    #[default]
    Normal,
    /// Also the technical detail behind it.
    Verbose,
}

static CHOSEN: OnceLock<Verbosity> = OnceLock::new();

impl Verbosity {
    /// Sets the verbosity of the whole process. Only the first call has an effect.
    pub fn choose(self) {
        let _ = CHOSEN.set(self);
    }

    /// The verbosity of the process.
    pub fn chosen() -> Self {
        CHOSEN.get().copied().unwrap_or_default()
    }
}
