//! Prints results to standard output.

use std::io::{Error, ErrorKind, Write};
use std::sync::OnceLock;

use super::paragraph::filled;
use super::{Verbosity, text as safe, width};
use crate::error::VerbError;

/// The first error while printing.
static NOT_PRINTED: OnceLock<Error> = OnceLock::new();

/// Prints text to standard output, made safe for a terminal and wrapped to its width. Prints nothing with `--quiet`.
///
/// A closed pipe is not an error. [`all_was_printed`] reports any other.
pub fn print(text: &str) {
    print_fitted(|width| filled(text, width));
}

/// As [`print()`], for text that is wrapped by its own rules. `text` receives the width; `None` without a terminal.
pub fn print_fitted(text: impl FnOnce(Option<usize>) -> String) {
    if Verbosity::chosen() > Verbosity::Quiet {
        write(&text(width()));
    }
}

/// Prints requested text, such as a schema or a model, without wrapping.
pub fn print_text(text: &str) {
    write(text);
}

/// As [`print()`], only with `--verbose`.
pub fn print_detail(text: &str) {
    if Verbosity::chosen() == Verbosity::Verbose {
        print(text);
    }
}

fn write(text: &str) {
    match writeln!(std::io::stdout(), "{}", safe(text)) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => drop(NOT_PRINTED.set(error)),
        _ => (),
    }
}

/// Fails if any output has not reached standard output: a full disk must not end as a success.
pub fn all_was_printed() -> Result<(), VerbError> {
    let flushed = std::io::stdout().flush().err().filter(|error| error.kind() != ErrorKind::BrokenPipe);
    match flushed.map(|error| error.to_string()).or_else(|| NOT_PRINTED.get().map(ToString::to_string)) {
        Some(reason) => Err(VerbError::NotPrinted(reason)),
        None => Ok(()),
    }
}
