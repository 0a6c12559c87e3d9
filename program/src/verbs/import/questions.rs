//! Asks about a guessed map: which source a signal has.

use std::collections::HashSet;
use std::io::{BufRead, Write};

use excavator_bags::map::{Confidence, Guess, GuessedSignal};

use crate::error::VerbError;
use crate::terminal;

/// Asks about every uncertain signal. Without an answer the guess stays.
pub(super) fn ask(guess: &mut Guess, input: &mut impl BufRead, output: &mut impl Write) -> Result<(), VerbError> {
    let mut asked = HashSet::new();
    // An answer may remove the source of another signal, which then needs no question.
    while let Some(number) = guess
        .signals
        .iter()
        .position(|guessed| guessed.confidence == Confidence::Unsure && !asked.contains(&guessed.source.signal))
    {
        let guessed = &guess.signals[number];
        asked.insert(guessed.source.signal.clone());
        match answer(guessed, input, output)? {
            None => return Ok(()),
            Some(0) => {}
            Some(choice) => guess.choose(number, choice - 1),
        }
    }
    Ok(())
}

/// The answer to one question: 0 for none, 1 for the guess, and so on; `None` at the end of the input.
fn answer(
    guessed: &GuessedSignal,
    input: &mut impl BufRead,
    output: &mut impl Write,
) -> Result<Option<usize>, VerbError> {
    let alternatives = guessed.alternatives.iter().map(|other| (other.label.as_str(), other.reason.as_str()));
    let choices: Vec<(&str, &str)> =
        std::iter::once((guessed.label.as_str(), guessed.reason.as_str())).chain(alternatives).collect();
    let mut shown = format!("\nWhich is {}?\n", guessed.source.signal);
    for (number, (label, reason)) in choices.iter().enumerate() {
        shown += &format!("  {}  {label}: {reason}\n", number + 1);
    }
    shown += "  0  none of them\n";
    write!(output, "{}", terminal::text(&shown))?;
    loop {
        write!(output, "number [1]: ")?;
        output.flush()?;
        let mut line = String::new();
        if input.read_line(&mut line)? == 0 {
            writeln!(output)?;
            return Ok(None);
        }
        match line.trim() {
            "" => return Ok(Some(1)),
            text => match text.parse::<usize>() {
                Ok(number) if number <= choices.len() => return Ok(Some(number)),
                _ => writeln!(output, "a number from 0 to {}", choices.len())?,
            },
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_bags::map::guess;

    use super::*;

    /// Three pressures without a hint to their places.
    fn guessed() -> Guess {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("drive.csv");
        let mut table = "t,stroke [mm],pressure x [bar],pressure y [bar]\n".to_string();
        for row in 0..100 {
            let swing = (0.1 * f64::from(row)).sin();
            table += &format!("{},{},{},{}\n", 0.01 * f64::from(row), 100.0 * swing, 90.0 + swing, 40.0 - swing);
        }
        std::fs::write(&path, table).unwrap();
        guess(&path, "arm").unwrap()
    }

    fn asked(answers: &str) -> (Vec<(String, String)>, String) {
        let mut guess = guessed();
        let mut shown = Vec::new();
        ask(&mut guess, &mut answers.as_bytes(), &mut shown).unwrap();
        let taken = guess.signals.iter().filter(|guessed| guessed.confidence > Confidence::Unsure);
        let taken = taken.map(|guessed| (guessed.source.signal.to_string(), guessed.label.clone()));
        (taken.collect(), String::from_utf8(shown).unwrap())
    }

    fn pair(signal: &str, label: &str) -> (String, String) {
        (signal.to_string(), label.to_string())
    }

    #[test]
    fn answers_are_taken_and_what_is_taken_is_not_offered_again() {
        let stroke = pair("arm.displacement", "stroke");
        let (taken, shown) = asked("\n\n");
        assert_eq!(
            taken,
            [stroke.clone(), pair("arm.cap_pressure", "pressure x"), pair("arm.rod_pressure", "pressure y")]
        );
        assert!(shown.contains("Which is arm.cap_pressure?") && shown.contains("2  pressure y"), "{shown}");
        let (taken, _) = asked("2\n1\n");
        assert_eq!(
            taken,
            [stroke.clone(), pair("arm.cap_pressure", "pressure y"), pair("arm.rod_pressure", "pressure x")]
        );
        let (taken, shown) = asked("many\n7\n0\n0\n");
        assert_eq!(taken, std::slice::from_ref(&stroke));
        assert_eq!(shown.matches("a number from 0 to 2").count(), 2, "{shown}");
        // The end of the input is not an answer.
        assert_eq!(asked("").0, [stroke]);
    }
}
