//! A number with its unit and its source.

use serde::{Deserialize, Serialize};

use super::DocumentError;

/// A known constant in a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Quantity {
    pub value: f64,
    pub unit: String,
    #[serde(default)]
    pub source: String,
}

/// What a known constant may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Must {
    BePositive,
    NotBeNegative,
    /// A gauge pressure in Pa.
    BeAboveVacuum,
    BeFinite,
}

/// Gauge pressure of a vacuum, Pa.
const VACUUM: f64 = -101_325.0;

impl Quantity {
    /// A constant with its unit; the source is looked up by the caller who knows it.
    pub fn new(value: f64, unit: &str) -> Self {
        Quantity { value, unit: unit.to_string(), source: String::new() }
    }

    /// The value, after checking unit and range.
    pub fn checked(&self, name: &str, quantity: &str, unit: &'static str, must: Must) -> Result<f64, DocumentError> {
        if self.unit != unit {
            return Err(DocumentError::WrongUnit {
                name: name.to_string(),
                quantity: quantity.to_string(),
                found: self.unit.clone(),
                expected: unit.to_string(),
            });
        }
        let possible = match must {
            Must::BePositive => self.value.is_finite() && self.value > 0.0,
            Must::NotBeNegative => self.value.is_finite() && self.value >= 0.0,
            Must::BeAboveVacuum => self.value.is_finite() && self.value >= VACUUM,
            Must::BeFinite => self.value.is_finite(),
        };
        if possible {
            Ok(self.value)
        } else {
            Err(DocumentError::Impossible {
                name: name.to_string(),
                quantity: quantity.to_string(),
                value: self.value,
                must: match must {
                    Must::BePositive => "a positive number".to_string(),
                    Must::NotBeNegative => {
                        "zero or a positive number; what turns the other way has a negative moment".to_string()
                    }
                    Must::BeAboveVacuum => format!("a gauge pressure of {VACUUM} Pa, a vacuum, or more"),
                    Must::BeFinite => "a finite number".to_string(),
                },
            })
        }
    }
}
