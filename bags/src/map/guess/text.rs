//! Writes a guess as a map with a reason on each line.

use std::fmt::Write;

use super::super::error::MapError;
use super::super::signal::SignalKind;
use super::{Confidence, Guess, GuessedSignal};

/// Column at which reasons start, so that the map is readable without them.
const REASON_COLUMN: usize = 52;

impl Guess {
    /// The guess as map text, with the reason for each line after it.
    ///
    /// # Errors
    /// [`MapError::Syntax`] if TOML cannot represent a number.
    pub fn to_text(&self) -> Result<String, MapError> {
        let mut text = format!("# Guessed from {}. Check every line, above all units, signs and offsets.\n", self.data);
        let unsure = self.signals.iter().filter(|guessed| guessed.confidence == Confidence::Unsure).count();
        if unsure > 0 {
            let comment = format!(
                "Not sure: {unsure} of {} signals. They are commented out: put the right source, then delete \"# \" in front of their \
                 lines.",
                self.signals.len()
            );
            push_comment(&mut text, &comment);
        }
        text.push_str("\n[clock]\n");
        let clock = toml_lines(&self.clock.0)?;
        if clock.is_empty() {
            push_line(&mut text, "# ", "rate = 500.0", &self.clock.1);
        }
        for line in clock {
            push_line(&mut text, "", &line, &self.clock.1);
        }
        for guessed in &self.signals {
            push_signal(&mut text, guessed)?;
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

/// The map entry of a signal, with reasons; commented out if it is not sure.
fn push_signal(text: &mut String, guessed: &GuessedSignal) -> Result<(), MapError> {
    let is_unsure = guessed.confidence == Confidence::Unsure;
    let mark = if is_unsure { "# " } else { "" };
    text.push('\n');
    push_line(text, mark, "[[signals]]", "");
    let reason = format!("{}: {}", guessed.confidence.name(), guessed.reason);
    for line in toml_lines(&guessed.source)? {
        let reason = match line.split_once(" = ").map_or("", |(key, _)| key) {
            "signal" => reason.as_str(),
            "unit" => guessed.unit_reason.as_str(),
            _ => "",
        };
        // A placeholder in force would be taken for the true scale; without it the next verb asks.
        let mark = if guessed.needs_scale && line.starts_with("scale = ") { "# " } else { mark };
        push_line(text, mark, &line, reason);
    }
    for alternative in &guessed.alternatives {
        let is_place = |line: &String| !line.starts_with("signal = ");
        let lines: Vec<String> = toml_lines(&alternative.source)?.into_iter().filter(is_place).collect();
        push_line(text, "#   or ", &lines.join(", "), &alternative.reason);
    }
    Ok(())
}

fn toml_lines<T: serde::Serialize>(value: &T) -> Result<Vec<String>, MapError> {
    let text = toml::to_string(value).map_err(|error| MapError::Syntax(error.to_string().into()))?;
    Ok(text.lines().map(str::to_string).collect())
}

fn push_line(text: &mut String, mark: &str, line: &str, reason: &str) {
    let line = format!("{mark}{line}");
    // Text from the data must not end a comment.
    let reason = reason.replace(char::is_control, " ");
    // Writing to a String cannot fail.
    let _ = match reason.is_empty() {
        true => writeln!(text, "{line}"),
        false => writeln!(text, "{line:<REASON_COLUMN$} # {reason}"),
    };
}

/// A comment, wrapped over several lines.
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
