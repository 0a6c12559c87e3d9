//! Translates names from the catalogue and the equations into the terms of a machine engineer.

use excavator_model::effects::{ActsOn, Card};

/// `valve_dead_zone` -> "valve dead zone".
pub(super) fn spoken(name: &str) -> String {
    name.replace('_', " ")
}

/// "valve dead zone at the arm", "relief valve at the pump line".
pub(super) fn effect_at(card: &Card, place: &str) -> String {
    let place = match (place, card.acts_on) {
        ("pump", _) => "the pump line".to_string(),
        ("machine", _) => "the whole machine".to_string(),
        (cylinder, ActsOn::Valve) => format!("the {cylinder} valve section"),
        (cylinder, _) => format!("the {cylinder} cylinder"),
    };
    let name = spoken(&card.name);
    format!("{name} at {place}")
}

/// `arm.cap_continuity` -> "oil balance of the arm's cap side".
pub(super) fn equation(name: &str) -> String {
    match name.split_once('.') {
        Some(("pump", "continuity")) => "oil balance of the pump line".to_string(),
        Some((cylinder, "motion")) => format!("force balance of the {cylinder}"),
        Some((cylinder, "cap_continuity")) => format!("oil balance of the {cylinder}'s cap side"),
        Some((cylinder, "rod_continuity")) => format!("oil balance of the {cylinder}'s rod side"),
        _ => spoken(name),
    }
}

/// `arm.cap_pressure` -> "Arm cap pressure".
pub(super) fn signal(name: &str) -> String {
    capitalised(&spoken(&name.replace('.', " ")))
}

/// "force balance of the arm" -> "Force balance of the arm", for a heading.
pub(super) fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// Name of a variable that a residual depends on.
pub(super) fn variable(name: &str) -> String {
    match name {
        "command" => "valve opening".to_string(),
        "speed" => "piston speed".to_string(),
        "position" => "piston position".to_string(),
        other => spoken(other),
    }
}

/// "a", "a and b", "a, b and c" with any last joining word.
pub(super) fn list(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [head @ .., tail] => format!("{} {last} {tail}", head.join(", ")),
    }
}
