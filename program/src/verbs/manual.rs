//! `excavator completions`, `excavator manual`

use clap_complete::Shell;

use crate::cli::ManualVerb;
use crate::error::VerbError;
#[cfg(feature = "live")]
use crate::manual::parameters_page;
use crate::manual::{command, results_page, verbs_page, write_man_pages, write_schemas};
use crate::terminal::{print, print_text};

/// Prints the completions of a shell.
pub fn completions(shell: Shell) {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut command(), "excavator", &mut script);
    print_text(String::from_utf8_lossy(&script).trim_end());
}

/// Writes man pages or schemas, or prints a page of the docs.
pub fn run(which: &ManualVerb) -> Result<(), VerbError> {
    match which {
        ManualVerb::Man { to } => {
            let written = write_man_pages(to).map_err(|source| VerbError::Write { path: to.clone(), source })?;
            print(&format!("{} man pages are in {}.", written.len(), to.display()));
        }
        ManualVerb::Schemas { to } => {
            let written = write_schemas(to).map_err(|source| VerbError::Write { path: to.clone(), source })?;
            print(&format!("{} schemas are in {}.", written.len(), to.display()));
        }
        ManualVerb::Verbs => print_text(verbs_page().trim_end()),
        #[cfg(feature = "live")]
        ManualVerb::Parameters => print_text(parameters_page().trim_end()),
        ManualVerb::Results => print_text(results_page().trim_end()),
    }
    Ok(())
}
