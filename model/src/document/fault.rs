//! What is wrong with a TOML text, with its place.

/// Longest message of the reader of TOML that is passed on, characters: it may quote what it does not know.
const LONGEST_MESSAGE: usize = 200;

/// Longest piece of the faulty line that is shown, characters.
const LONGEST_LINE: usize = 72;

/// What is wrong with a TOML text.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct TomlFault {
    /// What the reader of TOML says, in one line that begins with line and column.
    pub message: String,
    /// The faulty line with a mark at the place: three lines, or none where the place is unknown. For the person at the terminal;
    /// a stranger on the network may learn no text of a file.
    pub excerpt: String,
}

impl From<String> for TomlFault {
    /// A fault without a place.
    fn from(message: String) -> Self {
        TomlFault { message, excerpt: String::new() }
    }
}

/// What the reader of TOML says of `text`.
pub fn toml_fault(text: &str, error: &toml::de::Error) -> TomlFault {
    let message: String = error.message().trim().replace('\n', ", ").chars().take(LONGEST_MESSAGE).collect();
    let place = error.span().and_then(|span| Some((text.get(..span.start)?, text.get(span.start..)?, span)));
    let Some((before, from, span)) = place else { return message.into() };
    let number = before.matches('\n').count() + 1;
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    let left = before.get(start..).unwrap_or_default();
    let right = from.lines().next().unwrap_or_default();
    let column = left.chars().count() + 1;
    // Of a long line, what is around the place.
    let skipped = (column - 1).saturating_sub(LONGEST_LINE / 2);
    let shown: String = left.chars().chain(right.chars()).skip(skipped).take(LONGEST_LINE).map(visible).collect();
    let blanks = " ".repeat(column - 1 - skipped);
    let marked = text.get(span).map_or(1, |marked| marked.lines().next().unwrap_or_default().chars().count());
    let marks = "^".repeat(marked.clamp(1, (LONGEST_LINE - blanks.len()).max(1)));
    let margin = " ".repeat(number.to_string().len());
    let shown = shown.trim_end();
    TomlFault {
        message: format!("line {number}, column {column}: {message}"),
        excerpt: format!("{margin} |\n{number} | {shown}\n{margin} | {blanks}{marks}"),
    }
}

/// A character that takes one column of a terminal and does nothing else there.
fn visible(character: char) -> char {
    if character.is_control() { ' ' } else { character }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::{TomlFault, toml_fault};

    fn fault(text: &str) -> String {
        let TomlFault { message, excerpt } = toml_fault(text, &toml::from_str::<toml::Table>(text).unwrap_err());
        format!("{message}\n{excerpt}")
    }

    #[test]
    fn the_line_is_shown_with_a_mark_at_the_place() {
        let said = fault("a = 1\narea = 38 mm2\nb = 2\n");
        let lines: Vec<&str> = said.lines().collect();
        assert!(lines[0].starts_with("line 2, column "), "{said}");
        assert_eq!(lines[2], "2 | area = 38 mm2");
        assert!(lines[3].trim_start_matches([' ', '|']).starts_with('^'), "{said}");
    }

    #[test]
    fn a_long_line_is_cut_around_the_place_and_control_characters_do_nothing() {
        let text = format!("a = \"{}\" \u{1b} x", "é".repeat(5000));
        let said = fault(&text);
        assert!(said.lines().all(|line| line.chars().count() <= 300), "{said}");
        assert!(!said.contains('\u{1b}'));
        assert!(said.lines().last().unwrap().ends_with('^'));
        assert!(fault("a = ").lines().count() == 4 && fault("[").lines().count() == 4);
    }
}
