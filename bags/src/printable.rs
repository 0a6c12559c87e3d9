//! Text of others, made safe for a terminal or a log.

use std::borrow::Cow;

/// The text with everything that a terminal would act on replaced by a visible escape such as `\u{1b}`.
///
/// Names of topics, types and columns come from files. Control characters in them (C0, DEL, C1) can move the cursor, change
/// the title or hide a line, and marks of direction and line separators can show a name in another order than it has.
/// Everything else, also what is not ASCII, stays as it is.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.chars().any(acts_on_terminals) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if acts_on_terminals(character) {
            escaped.extend(character.escape_unicode());
        } else {
            escaped.push(character);
        }
    }
    Cow::Owned(escaped)
}

/// The same for a message that may end with the faulty line of a file and a mark under it: those three lines stay lines.
#[must_use]
pub fn printable_with_excerpt(text: &str) -> Cow<'_, str> {
    let lines: Vec<&str> = text.rsplitn(4, '\n').collect();
    let [mark, faulty, blank, message] = lines.as_slice() else { return printable(text) };
    let is_number = |text: &str| !text.is_empty() && text.chars().all(|digit| digit.is_ascii_digit());
    let is_excerpt = margin(blank) == Some("") && margin(faulty).is_some_and(is_number) && margin(mark) == Some("");
    if !is_excerpt {
        return printable(text);
    }
    Cow::Owned([*message, *blank, *faulty, *mark].map(printable).join("\n"))
}

/// What stands before the bar of a line of an excerpt.
fn margin(line: &str) -> Option<&str> {
    line.split_once('|').map(|(margin, _)| margin.trim())
}

/// Controls, and the marks that change the direction of the text around them (Unicode Standard Annex 9) or end a line.
fn acts_on_terminals(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{061c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_names_are_borrowed() {
        for name in ["/arm/state", "Drück [bar]", "шток", "圧力"] {
            assert!(matches!(printable(name), Cow::Borrowed(same) if same == name), "{name}");
        }
    }

    #[test]
    fn only_the_lines_of_an_excerpt_stay_lines() {
        let fault = "m.toml: line 2, column 5: a string\n  |\n2 | a = b\n  |     ^";
        assert_eq!(printable_with_excerpt(fault), fault);
        assert_eq!(printable_with_excerpt("a\nb"), r"a\u{a}b");
        assert_eq!(printable_with_excerpt("a\nb\nc\nd"), r"a\u{a}b\u{a}c\u{a}d");
        assert_eq!(printable_with_excerpt("x\ny\n  |\n2 | \u{1b}\n  | ^"), "x\\u{a}y\n  |\n2 | \\u{1b}\n  | ^");
    }

    #[test]
    fn what_a_terminal_acts_on_becomes_visible() {
        assert_eq!(printable("/a\x1b]0;title\x07"), r"/a\u{1b}]0;title\u{7}");
        assert_eq!(printable("a\nb\u{7f}\u{9b}2J"), r"a\u{a}b\u{7f}\u{9b}2J");
        assert_eq!(printable("user\u{202e}txt\u{2066}\u{200f}"), r"user\u{202e}txt\u{2066}\u{200f}");
    }
}
