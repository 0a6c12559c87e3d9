//! Makes untrusted text safe for a terminal or a log.

use std::borrow::Cow;
use std::path::Path;

/// Replaces every character that a terminal would interpret with a visible escape such as `\u{1b}`.
///
/// Names of topics, types and columns come from files. Control characters in them (C0, DEL, C1) can move the cursor,
/// change the title or hide a line. Direction marks and line separators can display a name in a different order.
/// Everything else, including non-ASCII text, is unchanged.
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

/// A path as [`printable`] text; parts that are not UTF-8 are replaced.
#[must_use]
pub fn printable_path(path: &Path) -> String {
    printable(&path.to_string_lossy()).into_owned()
}

/// Control characters, and marks that change the text direction (Unicode Standard Annex 9) or end a line.
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
    fn what_a_terminal_acts_on_becomes_visible() {
        assert_eq!(printable("/a\x1b]0;title\x07"), r"/a\u{1b}]0;title\u{7}");
        assert_eq!(printable("a\nb\u{7f}\u{9b}2J"), r"a\u{a}b\u{7f}\u{9b}2J");
        assert_eq!(printable("user\u{202e}txt\u{2066}\u{200f}"), r"user\u{202e}txt\u{2066}\u{200f}");
    }
}
