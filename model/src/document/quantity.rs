//! A number with its unit and its source. What it measures is part of its type, so that reading, schema and reference page cannot
//! differ in unit or range.

use std::borrow::Cow;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::DocumentError;

/// A known constant in a model file: what `M` says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound = "")]
pub(super) struct Quantity<M> {
    pub value: f64,
    pub unit: String,
    #[serde(default)]
    pub source: String,
    #[serde(skip)]
    measures: PhantomData<M>,
}

/// What a constant measures.
pub(super) trait Measure {
    /// The SI unit that it must be given in.
    const UNIT: &'static str;
    /// What it may be.
    const MUST: Must;
    /// Largest magnitude: no machine comes near it, so a larger number has another unit than it says.
    const LARGEST: f64;
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

macro_rules! measures {
    ($($name:ident $unit:literal $must:ident $largest:literal;)*) => {$(
        #[derive(Debug, Clone, PartialEq)]
        pub(super) struct $name;
        impl Measure for $name {
            const UNIT: &'static str = $unit;
            const MUST: Must = Must::$must;
            const LARGEST: f64 = $largest;
        }
    )*};
}

// The largest pistons are those of presses, 2 m2; the longest links those of draglines, 100 m; the largest motors turn winches,
// 0.01 m3/rad.
measures! {
    Acceleration "m/s2" NotBeNegative 1000.0;
    Angle "rad" BeFinite 1000.0;
    Area "m2" BePositive 10.0;
    Flow "m3/s" BePositive 100.0;
    Length "m" BePositive 1000.0;
    Position "m" BeFinite 1000.0;
    MotorVolume "m3/rad" BePositive 1.0;
    Pressure "Pa" BePositive 1e9;
    TankPressure "Pa" BeAboveVacuum 1e9;
    Volume "m3" BePositive 1000.0;
}

/// Gauge pressure of a vacuum, Pa.
const VACUUM: f64 = -101_325.0;

impl Must {
    fn allows(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Must::BePositive => value > 0.0,
                Must::NotBeNegative => value >= 0.0,
                Must::BeAboveVacuum => value >= VACUUM,
                Must::BeFinite => true,
            }
    }

    fn words(self) -> String {
        match self {
            Must::BePositive => "a positive number".to_string(),
            Must::NotBeNegative => {
                "zero or a positive number; what turns the other way has a negative moment".to_string()
            }
            Must::BeAboveVacuum => format!("a gauge pressure of {VACUUM} Pa, a vacuum, or more"),
            Must::BeFinite => "a finite number".to_string(),
        }
    }

    fn schema(self, largest: f64) -> Schema {
        match self {
            Must::BePositive => json_schema!({ "type": "number", "exclusiveMinimum": 0.0, "maximum": largest }),
            Must::NotBeNegative => json_schema!({ "type": "number", "minimum": 0.0, "maximum": largest }),
            Must::BeAboveVacuum => json_schema!({ "type": "number", "minimum": VACUUM, "maximum": largest }),
            Must::BeFinite => json_schema!({ "type": "number", "minimum": -largest, "maximum": largest }),
        }
    }
}

impl<M: Measure> Quantity<M> {
    /// A constant; the source is looked up by the caller who knows it.
    pub fn new(value: f64) -> Self {
        Quantity { value, unit: M::UNIT.to_string(), source: String::new(), measures: PhantomData }
    }

    /// The value, after checking unit and range.
    pub fn checked(&self, name: &str, quantity: &str) -> Result<f64, DocumentError> {
        if self.unit != M::UNIT {
            return Err(DocumentError::WrongUnit {
                name: name.to_string(),
                quantity: quantity.to_string(),
                found: self.unit.clone(),
                expected: M::UNIT.to_string(),
            });
        }
        let must = if !M::MUST.allows(self.value) {
            M::MUST.words()
        } else if self.value.abs() > M::LARGEST {
            format!("at most {} {}; is the number in another unit?", M::LARGEST, M::UNIT)
        } else {
            return Ok(self.value);
        };
        Err(DocumentError::Impossible {
            name: name.to_string(),
            quantity: quantity.to_string(),
            value: self.value,
            must,
        })
    }
}

impl<M: Measure> JsonSchema for Quantity<M> {
    fn schema_name() -> Cow<'static, str> {
        format!("Quantity in {}", M::UNIT).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "object",
            "properties": {
                "value": M::MUST.schema(M::LARGEST),
                "unit": { "const": M::UNIT },
                "source": { "type": "string", "description": "where the number comes from" },
            },
            "required": ["value", "unit"],
            "additionalProperties": false,
        })
    }
}
