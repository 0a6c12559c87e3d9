//! A guess as a map with a reason on each line.

use std::fmt::Write;

use super::super::error::MapError;
use super::super::signal::SignalKind;
use super::Guess;

/// Column at which reasons begin, so that the map can be read without them.
const REASON_COLUMN: usize = 52;

impl Guess {
    /// The guess as the text of a map, with the reason for each line behind it.
    ///
    /// # Errors
    /// [`MapError::Syntax`] when a number is none that TOML can hold.
    pub fn to_text(&self) -> Result<String, MapError> {
        let mut text =
            format!("# Guessed from {}. Check every line, above all units, signs and offsets.\n\n", self.data);
        text.push_str("[clock]\n");
        for line in toml_lines(&self.clock.0)? {
            push_line(&mut text, &line, &self.clock.1);
        }
        for guessed in &self.signals {
            text.push_str("\n[[signals]]\n");
            for line in toml_lines(&guessed.source)? {
                let reason = match line.split_once(" = ").map_or("", |(key, _)| key) {
                    "signal" => guessed.reason.as_str(),
                    "unit" => guessed.unit_reason.as_str(),
                    _ => "",
                };
                push_line(&mut text, &line, reason);
            }
        }
        let missing: Vec<&str> = SignalKind::ALL
            .into_iter()
            .filter(|kind| !self.signals.iter().any(|guessed| guessed.source.signal.kind == *kind))
            .map(SignalKind::name)
            .collect();
        text.push('\n');
        if !missing.is_empty() {
            push_comment(&mut text, &format!("not found: {}", missing.join(", ")));
        }
        if !self.left.is_empty() {
            push_comment(&mut text, &format!("not used: {}", self.left.join(", ")));
        }
        Ok(text)
    }
}

fn toml_lines<T: serde::Serialize>(value: &T) -> Result<Vec<String>, MapError> {
    let text = toml::to_string(value).map_err(|error| MapError::Syntax(error.to_string()))?;
    Ok(text.lines().map(str::to_string).collect())
}

fn push_line(text: &mut String, line: &str, reason: &str) {
    // Nothing that comes from the data may end a comment.
    let reason = reason.replace(char::is_control, " ");
    // Writing to a String cannot fail.
    let _ = match reason.is_empty() {
        true => writeln!(text, "{line}"),
        false => writeln!(text, "{line:<REASON_COLUMN$} # {reason}"),
    };
}

/// A comment over as many lines as it takes.
fn push_comment(text: &mut String, comment: &str) {
    let mut line = String::from("#");
    for word in comment.replace(char::is_control, " ").split(' ') {
        if line.len() + word.len() > 110 {
            let _ = writeln!(text, "{line}");
            line = String::from("#  ");
        }
        line.push(' ');
        line.push_str(word);
    }
    let _ = writeln!(text, "{line}");
}
