//! Makes foreign text safe for messages and logs.

/// Returns at most `longest` characters of `text`, in one line. Control characters and other invisible ones are escaped,
/// because a terminal would act on them.
pub(super) fn printable(text: &str, longest: usize) -> String {
    let mut shown = String::new();
    for (count, character) in text.chars().enumerate() {
        if count >= longest {
            shown.push('…');
            break;
        }
        if character == '\n' {
            shown.push(' ');
        } else if character.is_control() || is_invisible(character) {
            shown.extend(character.escape_unicode());
        } else {
            shown.push(character);
        }
    }
    shown
}

/// Characters that change the direction or the position of the following text.
fn is_invisible(character: char) -> bool {
    matches!(character, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{2069}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_are_written_out_and_long_texts_cut() {
        assert_eq!(printable("a\u{1b}[2J\nb\u{202e}c", 100), "a\\u{1b}[2J b\\u{202e}c");
        assert_eq!(printable("äöü", 2), "äö…");
        assert_eq!(printable("arm", 3), "arm");
    }
}
