//! Text on its way to a terminal.
//!
//! Names of topics, columns, cylinders and files come from others. What a terminal would act on in them is made visible where
//! text leaves the program, and not at each of the places that put a name into a sentence.

use std::borrow::Cow;
use std::io::IsTerminal;

pub use rosbag2::printable;

use crate::output::filled;
use crate::verbosity::Verbosity;

/// What our own text has besides printable characters: ends of lines, and headings of tables in bold. A name that has them
/// can be bold or begin a line, and no more.
const OURS: [&str; 3] = ["\n", "\u{1b}[1m", "\u{1b}[0m"];

/// A text of several lines.
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

/// A line on standard error: why something failed; it is broken where that is a terminal. Under it stands `excerpt`, the faulty line
/// of a file with a mark that has to stay under its place, unless that is empty.
pub fn complain(line: &str, excerpt: &str) {
    eprintln!("{}", filled(&printable(line), width_of_errors()));
    excerpt.lines().for_each(|line| eprintln!("{}", printable(line)));
}

/// A line on standard error that is worth knowing, unless nothing is to be said.
pub fn remark(line: &str) {
    if Verbosity::chosen() > Verbosity::Quiet {
        eprintln!("{}", filled(&printable(line), width_of_errors()));
    }
}

/// Columns for what is told on standard error; `None` where that is no terminal.
fn width_of_errors() -> Option<usize> {
    std::io::stderr().is_terminal().then(|| width().unwrap_or(80))
}

/// Columns of the terminal; `None` where standard output is none.
pub fn width() -> Option<usize> {
    // The library of the tables asks the terminal, once for a table.
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
