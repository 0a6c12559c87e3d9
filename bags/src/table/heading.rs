//! Parses names and units in the headings of columns.

use crate::map::{Dimension, Unit};

/// Splits a heading into name and unit: `p_A [bar]`, `stroke (mm)`, `flow / l/min`, `pressure_bar`.
pub(crate) fn split(heading: &str) -> (String, Option<String>) {
    let heading = heading.trim().trim_start_matches('\u{feff}').trim();
    for (open, close) in [('[', ']'), ('(', ')'), ('{', '}')] {
        if let Some((name, rest)) = heading.rsplit_once(open)
            && let Some((unit, after)) = rest.split_once(close)
            && let Some(unit) = Unit::named(unit)
        {
            // In `Flow (GPM) - Plot 0` the unit remains part of the name, since users refer to the column by that name.
            let name = if after.trim().is_empty() { name.trim() } else { heading };
            return (name.to_string(), Some(unit.name.to_string()));
        }
    }
    for separator in [" / ", " in ", ", ", "_", " "] {
        if let Some((name, unit)) = heading.rsplit_once(separator)
            && is_telling(unit)
            // "3 bar" above forces means forces at 3 bar.
            && name.trim().parse::<f64>().is_err()
            && let Some(unit) = Unit::named(unit).filter(|found| !is_a_word(unit, found.dimension))
        {
            // The unit remains part of a name like `time_ms`, since users refer to the column by that name.
            let name = if separator == "_" { heading } else { name.trim() };
            return (name.to_string(), Some(unit.name.to_string()));
        }
    }
    (heading.to_string(), None)
}

/// What stands in square brackets at the end of a heading.
pub(super) fn brackets(heading: &str) -> Option<&str> {
    let (_, rest) = heading.strip_suffix(']')?.rsplit_once('[')?;
    (!rest.is_empty() && !rest.bytes().all(|byte| byte.is_ascii_digit())).then_some(rest)
}

/// Whether a suffix without brackets is a unit: `p_A` is the pressure at port A, not a current, and `x_1` is the first
/// x.
fn is_telling(unit: &str) -> bool {
    unit.chars().count() > 1 || ["s", "m", "N", "V", "%"].contains(&unit)
}

/// Units that are words of a name where no brackets mark them: `of_day`, `pressure second`.
const NOUNS: [&str; 12] =
    ["day", "days", "second", "minute", "hour", "turn", "turns", "foot", "pound", "count", "bit", "cps"];

/// Whether a suffix that could be a unit is a word: `Boom Ms` is the measured boom, not a time.
fn is_a_word(ending: &str, dimension: Dimension) -> bool {
    let is_noun = NOUNS.contains(&ending.to_lowercase().as_str());
    is_noun || dimension == Dimension::Time && ending.chars().any(char::is_uppercase)
}

#[cfg(test)]
mod tests {
    use super::split;

    #[test]
    fn units_are_found_in_the_usual_spellings() {
        for (heading, name, unit) in [
            ("p_A [bar]", "p_A", Some("bar")),
            ("stroke (mm)", "stroke", Some("mm")),
            ("flow / l/min", "flow", Some("l/min")),
            ("Q [L/min]", "Q", Some("l/min")),
            ("angle [°]", "angle", Some("deg")),
            ("area [mm²]", "area", Some("mm2")),
            ("time_ms", "time_ms", Some("ms")),
            ("delay ms", "delay", Some("ms")),
            ("Boom Ms", "Boom Ms", None),
            ("\u{feff}time", "time", None),
            ("p_A", "p_A", None),
            ("u_V", "u_V", Some("V")),
            ("x_1", "x_1", None),
            ("3 bar", "3 bar", None),
            ("1 [bar]", "1", Some("bar")),
            ("Flow (GPM) - Plot 0", "Flow (GPM) - Plot 0", Some("gpm")),
            ("Voltage (volt)", "Voltage", Some("V")),
            ("count (of parts)", "count (of parts)", None),
            ("", "", None),
        ] {
            assert_eq!(split(heading), (name.to_string(), unit.map(str::to_string)), "{heading}");
        }
    }
}
