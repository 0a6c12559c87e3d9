//! Says what changed in a machine, in the words and units of a workshop.

use excavator_identification::change::{Changes, ParameterChange};
use excavator_identification::decision::Policy;
use excavator_model::Model;
use excavator_model::display::PressureUnit;

use super::numbers::{percent, with_margin};
use super::units::of_parameter;
use super::words;

/// Pressure at which leakages are stated, Pa: 100 bar.
const STATED_AT: f64 = 1e7;

/// Speed at which damping is stated, m/s.
const STATED_SPEED: f64 = 0.1;

/// Factor from SI, and the unit of a workshop for a parameter with this SI unit: leakage in l/min at 100 bar.
pub(super) fn workshop_unit(si: &str) -> (f64, String) {
    let at = match PressureUnit::shown() {
        PressureUnit::Bar => "100 bar",
        PressureUnit::Megapascal => "10 MPa",
    };
    match si {
        "m3/(s Pa)" => (6e4 * STATED_AT, format!("l/min at {at}")),
        "N s/m" => (STATED_SPEED, "N at 100 mm/s".to_string()),
        other => {
            let unit = of_parameter(other);
            (unit.factor, unit.symbol.to_string())
        }
    }
}

/// Value with its 95 % interval, in the unit of a workshop. `side` 0 is before, 1 is after.
pub fn workshop_value(one: &ParameterChange, side: usize) -> String {
    let (factor, unit) = workshop_unit(&one.unit);
    let text = with_margin(factor * one.values[side], factor * one.margins_95[side]);
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}

/// Change relative to the value before: `+35 %`; the factor, if it is more than threefold.
pub fn relative_change(one: &ParameterChange) -> String {
    change_of(one.values)
}

/// Change from one value to another, relative to the first.
pub(super) fn change_of([before, after]: [f64; 2]) -> String {
    let ratio = after / before;
    if ratio.is_finite() && ratio > 3.0 {
        return format!("{ratio:.1} times as much");
    }
    let sign = if after < before { "−" } else { "+" };
    format!("{sign}{}", percent(((after - before) / before).abs()))
}

/// Meaning and place of the parameter with this contract name: "leakage coefficient at the arm".
pub(super) fn spoken(meaning: &str, name: &str) -> String {
    let place = name.split_once('.').map_or("", |(place, _)| place);
    format!("{meaning} at the {place}")
}

/// What changed, what did not, and whether the model still explains both sides.
pub fn change_sentence(model: &Model, changes: &Changes) -> String {
    let machine = &model.machine.name;
    let changed: Vec<String> = changes
        .changed()
        .map(|one| {
            format!(
                "{}: {} before, {} after ({})",
                spoken(&one.meaning, &one.name),
                workshop_value(one, 0),
                workshop_value(one, 1),
                relative_change(one)
            )
        })
        .collect();
    let same: Vec<String> = changes.unchanged().map(|one| one.name.clone()).collect();
    let unknown: Vec<String> = changes.undetermined().map(|one| one.name.clone()).collect();
    let mut sentences = vec![match changed.as_slice() {
        [] => {
            let least = 100.0 * Policy::default().least_change;
            format!("No parameter of {machine} changed by more than its uncertainty and by {least:.0} %.")
        }
        some => format!("Changed in {machine}: {}.", some.join("; ")),
    }];
    if !same.is_empty() {
        sentences.push(format!("Unchanged: {}.", words::list(&same, "and")));
    }
    if !unknown.is_empty() {
        sentences.push(format!("Not determined on both sides: {}.", words::list(&unknown, "and")));
    }
    sentences.extend(match changes.leaves_more_than_noise() {
        [false, true] => Some(
            "After, the model leaves more than noise with any parameters: an effect that it lacks is new. Diagnose the recordings after."
                .to_string(),
        ),
        [true, false] => Some("Before, the model leaves more than noise with any parameters: an effect that it lacks is gone.".to_string()),
        [true, true] => Some(
            "The model leaves more than noise on both sides, so that parameters may stand for effects that it lacks. Diagnose it first."
                .to_string(),
        ),
        [false, false] => None,
    });
    sentences.join(" ")
}
