//! Wraps sentences and commands to the width of the terminal.

/// Widest line of text on a terminal, columns: longer lines are hard to read.
const WIDEST: usize = 100;

/// Wraps the lines of `text` between words so that none is longer than `width` columns. The continuation of an indented line
/// aligns with its first word. Longer words are not broken, and neither are lines of tables.
pub fn filled(text: &str, width: Option<usize>) -> String {
    let Some(width) = width.map(|width| width.clamp(20, WIDEST)) else { return text.to_string() };
    text.lines().map(|line| filled_line(line, width)).collect::<Vec<_>>().join("\n")
}

fn filled_line(line: &str, width: usize) -> String {
    let is_table = line.chars().next().is_some_and(|first| ('\u{2500}'..='\u{257f}').contains(&first));
    if is_table || line.chars().count() <= width {
        return line.to_string();
    }
    let indent: String = line.chars().take_while(|character| *character == ' ').collect();
    let mut lines = Vec::new();
    let mut current = indent.clone();
    for word in line.split_whitespace() {
        let is_first = current.trim().is_empty();
        if !is_first && current.chars().count() + 1 + word.chars().count() > width {
            lines.push(std::mem::replace(&mut current, format!("{indent}{word}")));
            continue;
        }
        if !is_first {
            current.push(' ');
        }
        current.push_str(word);
    }
    lines.push(current);
    lines.join("\n")
}

/// A command that can be pasted into a shell, wrapped before options if it is longer than `width` columns.
pub fn command(words: &[String], width: Option<usize>) -> String {
    let words: Vec<String> = words.iter().map(|word| quoted(word)).collect();
    let Some(width) = width.filter(|width| words.iter().map(|word| word.len() + 1).sum::<usize>() + 2 > *width) else {
        return format!("  {}", words.join(" "));
    };
    // An option stays on one line with its values.
    let mut groups: Vec<String> = Vec::new();
    for word in words {
        match groups.last_mut() {
            Some(group) if !word.starts_with('-') => *group += &format!(" {word}"),
            _ => groups.push(word),
        }
    }
    let mut lines: Vec<String> = Vec::new();
    for group in groups {
        match lines.last_mut() {
            // One space before the group, and two columns for the backslash.
            Some(line) if line.chars().count() + group.chars().count() + 3 <= width => *line += &format!(" {group}"),
            Some(_) => lines.push(format!("      {group}")),
            None => lines.push(format!("  {group}")),
        }
    }
    lines.join(" \\\n")
}

/// A word, quoted for a shell where necessary.
fn quoted(word: &str) -> String {
    let is_plain = |character: char| character.is_alphanumeric() || "-_./@:=+,%".contains(character);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_string()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_line_of_words_is_too_long() {
        let text = "one two three four five six seven eight nine ten\n  a list item that is longer than the line is\n│ table stays as it is, however wide │";
        let filled = filled(text, Some(30));
        let lines: Vec<&str> = filled.lines().collect();
        assert!(lines[..lines.len() - 1].iter().all(|line| line.len() <= 30), "{filled}");
        assert!(lines.contains(&"  a list item that is longer"), "{filled}");
        assert_eq!(super::filled(text, None), text);
    }

    #[test]
    fn a_command_can_be_pasted() {
        let words = ["excavator", "compare", "--model", "my model.toml", "--bag", "it's"].map(String::from);
        assert_eq!(command(&words, None), r"  excavator compare --model 'my model.toml' --bag 'it'\''s'");
        let broken = command(&words, Some(40));
        assert_eq!(broken, "  excavator compare \\\n      --model 'my model.toml' \\\n      --bag 'it'\\''s'");
    }
}
