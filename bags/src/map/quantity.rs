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

/// A ratio of two units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ratio {
    /// In SI units.
    pub factor: f64,
    /// Dimension of the unit above the slash; `None` for a plain number.
    pub over: Option<Dimension>,
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

    /// The SI value of a ratio: a unit that the signal takes, per one of dimension `from`. A volume per turn makes a flow of the
    /// speed of a pump.
    pub(super) fn ratio_to_si(
        &self,
        signal: &str,
        from: Dimension,
        takes: impl Fn(Dimension) -> bool,
    ) -> Result<Ratio, MapError> {
        let bad = || self.bad(signal, "scale", "25 bar/V");
        match self {
            Quantity::Number(number) => Ok(Ratio { factor: finite(*number, signal, "scale")?, over: None }),
            Quantity::Text(text) => {
                let (number, units) = split(text).ok_or_else(bad)?;
                // Units can contain slashes: l/min per rpm, mm/s per V, l/min per rad/s.
                let ratio = units.match_indices('/').find_map(|(at, slash)| {
                    let (over, under) = (&units[..at], Unit::named(&units[at + slash.len()..])?);
                    if from == Dimension::RotationalSpeed
                        && under.dimension == Dimension::Angle
                        && takes(Dimension::Flow)
                    {
                        return Some((volume(over)? / under.factor(), Dimension::Flow));
                    }
                    let over = Unit::named(over).filter(|unit| takes(unit.dimension))?;
                    (under.dimension == from).then(|| (over.factor() / under.factor(), over.dimension))
                });
                let (ratio, over) = ratio.ok_or_else(bad)?;
                Ok(Ratio { factor: number * ratio, over: Some(over) })
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

/// SI value of a unit of volume, which no signal has.
fn volume(name: &str) -> Option<f64> {
    const VOLUMES: [(&str, f64); 6] =
        [("m3", 1.0), ("l", 1e-3), ("ml", 1e-6), ("cm3", 1e-6), ("ccm", 1e-6), ("in3", 1.638_706_4e-5)];
    let name = name.trim().replace('³', "3").replace('^', "");
    VOLUMES.iter().find(|(known, _)| *known == name).map(|(_, factor)| *factor)
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
