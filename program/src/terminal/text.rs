//! Makes text safe for a terminal.
//!
//! Names of topics, columns, cylinders and files come from foreign data. Control characters in them are made visible where text
//! leaves the program, and not at each place that puts a name into a sentence.

use std::borrow::Cow;
use std::io::{IsTerminal, Write};

pub use rosbag2::printable;

use super::Verbosity;
use super::paragraph::filled;

/// What our own text contains besides printable characters: line ends, and bold headings of tables. A name that contains these
/// can at most be bold or start a new line.
const OURS: [&str; 3] = ["\n", "\u{1b}[1m", "\u{1b}[0m"];

/// Text of several lines.
pub fn text(text: &str) -> Cow<'_, str> {
    if text.split('\n').all(|line| matches!(printable(line), Cow::Borrowed(_))) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    let mut rest = text;
    while !rest.is_empty() {
        let next = OURS.iter().filter_map(|ours| Some((rest.find(ours)?, *ours))).min_by_key(|(at, _)| *at);
        let (at, ours) = next.unwrap_or((rest.len(), ""));
        shown.push_str(&printable(&rest[..at]));
        shown.push_str(ours);
        rest = &rest[at + ours.len()..];
    }
    Cow::Owned(shown)
}

/// Prints the reason of a failure on standard error. The line is wrapped if standard error is a terminal. `excerpt` follows
/// below unless it is empty: the faulty line of a file with a mark that has to stay under its position.
pub fn complain(line: &str, excerpt: &str) {
    to_errors(&filled(&printable(line), width_of_errors()));
    excerpt.lines().for_each(|line| to_errors(&printable(line)));
}

/// Writes a line to standard error. If nobody reads it, the work goes on all the same.
fn to_errors(line: &str) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Prints a remark on standard error, unless `--quiet` is given.
pub fn remark(line: &str) {
    if Verbosity::chosen() > Verbosity::Quiet {
        to_errors(&filled(&printable(line), width_of_errors()));
    }
}

/// Columns available on standard error; `None` if it is not a terminal.
fn width_of_errors() -> Option<usize> {
    std::io::stderr().is_terminal().then(|| width().unwrap_or(80))
}

/// Columns of the terminal; `None` if standard output is not a terminal.
pub fn width() -> Option<usize> {
    // The table library queries the terminal, once per table.
    let mut table = comfy_table::Table::new();
    table.set_content_arrangement(comfy_table::ContentArrangement::Dynamic);
    table.width().map(usize::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_bold_headings_stay_and_nothing_else_acts() {
        assert!(matches!(text("one\ntwo\n"), Cow::Borrowed(_)));
        let table = "\u{1b}[1mname\u{1b}[0m\n\u{1b}]0;title\u{7}\u{1b}[2J\u{202e}";
        assert_eq!(text(table), "\u{1b}[1mname\u{1b}[0m\n\\u{1b}]0;title\\u{7}\\u{1b}[2J\\u{202e}");
    }
}
