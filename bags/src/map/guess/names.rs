//! Evidence from names.

use super::super::signal::SignalKind;
use super::super::unit::Dimension;

/// Cylinder names in other vocabularies, with ours.
const CYLINDERS: [(&str, &str); 7] = [
    ("boom", "boom"),
    ("arm", "arm"),
    ("stick", "arm"),
    ("dipper", "arm"),
    ("bucket", "bucket"),
    ("swing", "swing"),
    ("load", "load"),
];
/// Words for rotating machines, which are not cylinders.
const ROTATING: [&str; 6] = ["pump", "pumpe", "engine", "rpm", "drehzahl", "diesel"];

/// Words for what is measured.
const QUANTITIES: [(Dimension, &[&str]); 7] = [
    (Dimension::Pressure, &["pressure", "press", "p", "druck", "bar", "chamber"]),
    (
        Dimension::Length,
        &["displacement", "position", "pos", "stroke", "extension", "length", "x", "s", "qm", "laser", "weg"],
    ),
    (Dimension::Velocity, &["velocity", "vel", "speed", "v", "dx", "xd", "xdot"]),
    (Dimension::Angle, &["angle", "theta", "rotation", "q", "phi"]),
    (Dimension::Force, &["force", "effort", "f", "kraft", "loadcell"]),
    (Dimension::Flow, &["flow", "qp", "volumenstrom"]),
    (Dimension::Temperature, &["temperature", "temp", "t"]),
];
/// Words for the place of a pressure.
const PLACES: [(SignalKind, &[&str]); 4] = [
    (SignalKind::CapPressure, &["cap", "bore", "head", "bottom", "a", "1", "plus", "piston", "fluid_a"]),
    (SignalKind::RodPressure, &["rod", "annulus", "ring", "b", "2", "minus"]),
    (SignalKind::PumpPressure, &["pump", "supply", "system", "ps", "pp", "s", "feed"]),
    (SignalKind::TankPressure, &["tank", "return", "reservoir", "pt", "t"]),
];
const COMMANDS: [&str; 16] = [
    "command",
    "cmd",
    "ref",
    "reference",
    "setpoint",
    "desired",
    "valve",
    "ventil",
    "u",
    "input",
    "r",
    "joystick",
    "lever",
    "joy",
    "soll",
    "pwm",
];
/// Words that distinguish a measured value from a setpoint.
const MEASURED: [&str; 10] =
    ["ms", "meas", "measured", "measurement", "actual", "act", "ist", "feedback", "fbk", "sensor"];
const OPENINGS: [&str; 4] = ["spool", "opening", "orifice", "area"];

/// How well a name matches a signal, 0 to 1, and the matching word.
pub(super) fn score(kind: SignalKind, words: &[String]) -> Option<(f64, String)> {
    let command = find(words, &COMMANDS);
    let opening = find(words, &OPENINGS);
    match kind {
        // The reference of a position is no input of a valve.
        SignalKind::OrificeCommand => command.filter(|(_, word)| {
            let motion = [Dimension::Length, Dimension::Angle];
            let names_motion = |dimension| find(words, quantity(dimension)).is_some_and(|(_, of)| of.len() > 2);
            !motion.into_iter().any(names_motion) || word.starts_with('v')
        }),
        SignalKind::OrificeArea => opening.filter(|_| command.as_ref().is_none_or(|(_, word)| word.starts_with("v"))),
        // A command is not a measurement.
        _ if command.as_ref().is_some_and(|(_, word)| word.len() > 1 && !word.starts_with("v")) => None,
        SignalKind::CapPressure | SignalKind::RodPressure | SignalKind::PumpPressure | SignalKind::TankPressure => {
            let places = PLACES.iter().find(|(place, _)| *place == kind).map_or(&[][..], |(_, places)| places);
            let (what, word) = find(words, quantity(Dimension::Pressure)).or_else(|| joined(words, places))?;
            match find(words, places) {
                Some((place, place_word)) => Some((0.5 * (what + place), format!("{word}, {place_word}"))),
                None => Some((0.35 * what, word)),
            }
        }
        // The speed of a pump is not that of a cylinder, however strong the correlation.
        _ if kind.is_of_cylinder() && find(words, &ROTATING).is_some() => None,
        _ => find(words, quantity(kind.dimension())),
    }
}

/// Whether a name marks a measured value of any kind.
pub(super) fn is_measured(words: &[String]) -> bool {
    find(words, &MEASURED).is_some()
}

/// Whether a name refers to a pump.
pub(super) fn is_of_pump(words: &[String]) -> bool {
    find(words, &["pump", "pumpe"]).is_some()
}

/// The cylinder that a name refers to.
pub(super) fn cylinder(words: &[String]) -> Option<&'static str> {
    CYLINDERS.into_iter().find(|(word, _)| words.iter().any(|found| found == word)).map(|(_, name)| name)
}

fn quantity(dimension: Dimension) -> &'static [&'static str] {
    QUANTITIES.iter().find(|(of, _)| *of == dimension).map_or(&[][..], |(_, words)| words)
}

/// A wanted word of at least this many letters also matches inside another word: `Pumpendruck`, `chambers`.
const LETTERS_WITHIN: usize = 4;

/// The longest word that equals, or contains, a wanted one. Words of one or two letters score lower.
fn find(words: &[String], wanted: &[&str]) -> Option<(f64, String)> {
    let found = words
        .iter()
        .filter(|word| wanted.iter().any(|w| word == w || (w.len() >= LETTERS_WITHIN && word.contains(w))))
        .max_by_key(|word| word.len())?;
    let weight = if found.len() > 2 { 1.0 } else { 0.6 };
    Some((weight, found.clone()))
}

/// `ps`, `pt`: quantity and place combined in one word.
fn joined(words: &[String], places: &[&str]) -> Option<(f64, String)> {
    let word = words.iter().find(|word| word.starts_with('p') && places.contains(&word.as_str()) && word.len() == 2)?;
    Some((0.6, word.clone()))
}
