//! Lists implausible fitted values in a plain sentence.

use excavator_identification::plausibility::{Doubt, Implausible, implausible};
use excavator_model::Model;

use super::numbers::significant;
use super::words;

/// Largest number of listed values. The rest are counted.
const LISTED: usize = 4;

/// The implausible values of `found`, which was `given` before the fit, and what to check. Returns `None` if there are
/// none.
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
