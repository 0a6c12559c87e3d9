//! Fitted values that are hard to believe, in a plain sentence.

use excavator_identification::plausibility::{Doubt, Implausible, implausible};
use excavator_model::Model;

use super::numbers::significant;
use super::words;

/// Most values that are listed; the rest are counted.
const LISTED: usize = 4;

/// What is hard to believe of the values of `found`, which was `given` before it was fitted, and what to check; `None` where that is
/// nothing.
pub fn implausible_sentence(given: &Model, found: &Model) -> Option<String> {
    let all = implausible(given, found);
    if all.is_empty() {
        return None;
    }
    let mut told: Vec<String> = all.iter().take(LISTED).map(told).collect();
    if all.len() > LISTED {
        told.push(format!("{} more", all.len() - LISTED));
    }
    Some(format!(
        "Hard to believe: {}. Check the units of the recorded pressures and openings, and the areas and lengths in the model file, \
         unless these are guesses. A wrong unit or area can fit as well as the right one.",
        words::list(&told, "and")
    ))
}

fn told(one: &Implausible) -> String {
    let value = format!("{} = {} {}", one.name, significant(one.value, 3), one.unit);
    match one.why {
        Doubt::FarFromGiven { given } => format!("{value} (the model was given {})", significant(given, 3)),
        Doubt::StifferThanFluid => format!("{value} (no oil is that stiff)"),
    }
}
