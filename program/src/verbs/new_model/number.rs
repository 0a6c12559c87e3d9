//! Parses numbers with units, as on a data sheet.

use excavator_bags::map::{Dimension, Unit};

use crate::error::VerbError;

/// Units of a data sheet that no signal of a recording has: name, SI unit and SI value of one.
const OTHERS: [(&str, &str, f64); 12] = [
    ("kg", "kg", 1.0),
    ("t", "kg", 1e3),
    ("g", "kg", 1e-3),
    ("kgm2", "kg m2", 1.0),
    ("kgm", "kg m", 1.0),
    ("Nm", "N m", 1.0),
    ("kNm", "N m", 1e3),
    ("cm3", "m3", 1e-6),
    ("ccm", "m3", 1e-6),
    ("l", "m3", 1e-3),
    ("ml", "m3", 1e-6),
    ("m3", "m3", 1.0),
];

fn wrong(option: &str, text: &str, example: &str) -> VerbError {
    VerbError::NewModel(format!("{option} \"{text}\" is no number with a unit, as in {option} \"{example}\""))
}

/// The number in front and the unit behind it. A decimal comma is accepted.
fn split(text: &str) -> Option<(f64, String)> {
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.,eE".contains(c))).unwrap_or(text.len());
    // A trailing e belongs to an exponent, not to a unit.
    let number = text[..end].trim_end_matches(['e', 'E']).replace(',', ".").parse().ok()?;
    let unit: String = text[end..].chars().filter(|c| !c.is_whitespace() && !"^·".contains(*c)).collect();
    Some((number, unit.replace('²', "2").replace('³', "3"))).filter(|(number, _): &(f64, _)| number.is_finite())
}

/// The SI value of a number with this dimension.
pub fn of(option: &str, text: &str, dimension: Dimension, example: &str) -> Result<f64, VerbError> {
    split(text)
        .and_then(|(number, unit)| Some((number, Unit::named(&unit)?)))
        .filter(|(_, unit)| unit.dimension == dimension)
        .map(|(number, unit)| number * unit.factor())
        .ok_or_else(|| wrong(option, text, example))
}

/// As `of`, for quantities that recordings do not contain. `unit` is the SI unit.
pub fn other(option: &str, text: &str, unit: &str, example: &str) -> Result<f64, VerbError> {
    let (number, found) = split(text).ok_or_else(|| wrong(option, text, example))?;
    let factor = OTHERS.iter().find(|(name, si, _)| *name == found && *si == unit).map(|(.., factor)| factor);
    factor.map(|factor| number * factor).ok_or_else(|| wrong(option, text, example))
}

/// Numbers without units, separated by any other characters: "16/10 x 100".
pub fn plain<const N: usize>(option: &str, text: &str, example: &str) -> Result<[f64; N], VerbError> {
    let numbers: Vec<f64> = text
        .split(|c: char| !(c.is_ascii_digit() || c == '.'))
        .filter(|part| !part.is_empty())
        .filter_map(|part| part.parse().ok())
        .collect();
    numbers.try_into().map_err(|_| {
        VerbError::NewModel(format!("{option} \"{text}\" is not {N} numbers, as in {option} \"{example}\""))
    })
}

/// The input of a valve: its value in the model's unit, and the dimension.
pub fn command(option: &str, text: &str) -> Result<(f64, Dimension), VerbError> {
    split(text)
        .and_then(|(number, unit)| Some((number, unit.clone(), Unit::named(&unit)?)))
        .filter(|(_, _, unit)| {
            matches!(unit.dimension, Dimension::Area | Dimension::Voltage | Dimension::Current | Dimension::Number)
        })
        .map(|(number, _, unit)| (number * unit.factor(), unit.dimension))
        .ok_or_else(|| wrong(option, text, "10 V"))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_units() {
        assert!((of("--supply", "70 bar", Dimension::Pressure, "").unwrap() - 7e6).abs() < 1e-3);
        assert!((of("--supply", "7,5MPa", Dimension::Pressure, "").unwrap() - 7.5e6).abs() < 1e-3);
        assert!((other("--motor", "50 cm³", "m3", "").unwrap() - 5e-5).abs() < 1e-18);
        assert!((other("--inertia", "40 kg m^2", "kg m2", "").unwrap() - 40.0).abs() < 1e-12);
        assert_eq!(plain::<3>("--cylinder", "16/10 x 100 mm", "").unwrap(), [16.0, 10.0, 100.0]);
        assert_eq!(command("--command", "20 mA").unwrap(), (0.02, Dimension::Current));
        for (text, said) in [("bar", "70 bar"), ("70", "70 bar"), ("70 mm", "70 bar"), ("1e999 bar", "70 bar")] {
            let error = of("--supply", text, Dimension::Pressure, "70 bar").unwrap_err().to_string();
            assert!(error.contains(text) && error.contains(said), "{error}");
        }
        assert!(plain::<3>("--cylinder", "16/10", "16/10 x 100").is_err() && command("--command", "5 bar").is_err());
    }
}
