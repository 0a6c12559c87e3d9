//! Numbers with or without a unit.

use serde::{Deserialize, Serialize};

use super::error::MapError;
use super::unit::{Dimension, Unit};

/// A number in SI units, or text with its unit: `"-350 mm"`, `"25 bar/V"`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Quantity {
    /// In SI units.
    Number(f64),
    /// With unit.
    Text(String),
}

impl Quantity {
    /// The SI value of a quantity with this dimension. Treated as a difference, so that `"10 K"` is 10 K.
    pub(super) fn to_si(&self, signal: &str, key: &'static str, dimension: Dimension) -> Result<f64, MapError> {
        match self {
            Quantity::Number(number) => finite(*number, signal, key),
            Quantity::Text(text) => split(text)
                .and_then(|(number, unit)| Some((number, Unit::named(unit)?)))
                .filter(|(_, unit)| unit.dimension == dimension)
                .map(|(number, unit)| number * unit.factor())
                .ok_or_else(|| self.bad(signal, key, "-350 mm")),
        }
    }

    /// The SI value of a ratio `to` per `from`.
    pub(super) fn ratio_to_si(&self, signal: &str, from: Dimension, to: Dimension) -> Result<f64, MapError> {
        let bad = || self.bad(signal, "scale", "25 bar/V");
        match self {
            Quantity::Number(number) => finite(*number, signal, "scale"),
            Quantity::Text(text) => {
                let (number, units) = split(text).ok_or_else(bad)?;
                // Units can contain slashes: l/min per rpm, mm/s per V, l/min per rad/s.
                let ratio = units.match_indices('/').find_map(|(at, slash)| {
                    let over = Unit::named(&units[..at]).filter(|unit| unit.dimension == to)?;
                    let under = Unit::named(&units[at + slash.len()..]).filter(|unit| unit.dimension == from)?;
                    Some(over.factor() / under.factor())
                });
                Ok(number * ratio.ok_or_else(bad)?)
            }
        }
    }

    fn bad(&self, signal: &str, key: &'static str, example: &'static str) -> MapError {
        let text = match self {
            Quantity::Number(number) => number.to_string(),
            Quantity::Text(text) => text.clone(),
        };
        MapError::BadQuantity { signal: signal.to_string(), key, text, example }
    }
}

fn finite(number: f64, signal: &str, key: &'static str) -> Result<f64, MapError> {
    if number.is_finite() {
        return Ok(number);
    }
    Err(MapError::BadNumber { place: signal.to_string(), key, found: number, wanted: "a finite number" })
}

/// The leading number and the unit after it.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let end = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE_".contains(c))).unwrap_or(text.len());
    let number = text[..end].replace('_', "").parse().ok().filter(|number: &f64| number.is_finite())?;
    Some((number, text[end..].trim()))
}
