//! One parameter: value, description, type and range.

/// Value of a parameter, in one of the types of ROS 2.
#[derive(Debug, Clone, PartialEq)]
#[allow(missing_docs)]
pub enum Value {
    Boolean(bool),
    Integer(i64),
    Double(f64),
    String(String),
    BooleanArray(Vec<bool>),
    IntegerArray(Vec<i64>),
    DoubleArray(Vec<f64>),
    StringArray(Vec<String>),
}

/// Type of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Kind {
    Boolean,
    Integer,
    Double,
    String,
    BooleanArray,
    IntegerArray,
    DoubleArray,
    StringArray,
}

impl Kind {
    /// Name as `ros2 param describe` prints it.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Boolean => "boolean",
            Kind::Integer => "integer",
            Kind::Double => "double",
            Kind::String => "string",
            Kind::BooleanArray => "boolean array",
            Kind::IntegerArray => "integer array",
            Kind::DoubleArray => "double array",
            Kind::StringArray => "string array",
        }
    }
}

impl Value {
    /// Type of the value.
    pub fn kind(&self) -> Kind {
        match self {
            Value::Boolean(_) => Kind::Boolean,
            Value::Integer(_) => Kind::Integer,
            Value::Double(_) => Kind::Double,
            Value::String(_) => Kind::String,
            Value::BooleanArray(_) => Kind::BooleanArray,
            Value::IntegerArray(_) => Kind::IntegerArray,
            Value::DoubleArray(_) => Kind::DoubleArray,
            Value::StringArray(_) => Kind::StringArray,
        }
    }

    /// The value of a boolean parameter.
    pub fn as_bool(&self) -> Option<bool> {
        if let Value::Boolean(value) = self { Some(*value) } else { None }
    }

    /// The value of an integer parameter.
    pub fn as_integer(&self) -> Option<i64> {
        if let Value::Integer(value) = self { Some(*value) } else { None }
    }

    /// The value of a numeric parameter.
    pub fn as_double(&self) -> Option<f64> {
        match self {
            Value::Double(value) => Some(*value),
            Value::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }

    /// The value of a string parameter.
    pub fn as_text(&self) -> Option<&str> {
        if let Value::String(value) = self { Some(value) } else { None }
    }

    /// Converts the value to `kind` if nothing is lost: integers to doubles, empty lists to any list, and numbers from
    /// YAML to text. ROS itself refuses `-p rate:=500` for a double, which helps nobody.
    pub fn fitted_to(self, kind: Kind) -> Option<Value> {
        if self.kind() == kind {
            return Some(self);
        }
        match (self, kind) {
            (Value::Integer(value), Kind::Double) => Some(Value::Double(value as f64)),
            (Value::IntegerArray(values), Kind::DoubleArray) => {
                Some(Value::DoubleArray(values.into_iter().map(|value| value as f64).collect()))
            }
            (Value::Integer(value), Kind::String) => Some(Value::String(value.to_string())),
            (Value::StringArray(values), kind) if values.is_empty() => match kind {
                Kind::BooleanArray => Some(Value::BooleanArray(Vec::new())),
                Kind::IntegerArray => Some(Value::IntegerArray(Vec::new())),
                Kind::DoubleArray => Some(Value::DoubleArray(Vec::new())),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Range of a numeric parameter, both ends included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
}

/// A declared parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Name.
    pub name: &'static str,
    /// What the parameter does, with its unit.
    pub description: &'static str,
    /// Range of a number; for arrays, of every element.
    pub range: Option<Range>,
    /// Whether the value is fixed while the node runs.
    pub read_only: bool,
    /// Current value.
    pub value: Value,
}

impl Parameter {
    /// A parameter that can be set while the node runs.
    pub fn new(name: &'static str, value: Value, description: &'static str) -> Self {
        Parameter { name, description, range: None, read_only: false, value }
    }

    /// The same, with a range.
    #[must_use]
    pub fn within(self, from: f64, to: f64) -> Self {
        Parameter { range: Some(Range { from, to }), ..self }
    }

    /// The same, fixed while the node runs.
    #[must_use]
    pub fn read_only(self) -> Self {
        Parameter { read_only: true, ..self }
    }

    /// Converts and checks a value for this parameter, or returns the reason why it does not fit.
    pub fn checked(&self, value: Value) -> Result<Value, String> {
        let found = value.kind();
        let value = value
            .fitted_to(self.value.kind())
            .ok_or_else(|| format!("{} is a {}, not a {}", self.name, self.value.kind().name(), found.name()))?;
        let numbers: Vec<f64> = match &value {
            Value::Integer(number) => vec![*number as f64],
            Value::Double(number) => vec![*number],
            Value::IntegerArray(numbers) => numbers.iter().map(|&number| number as f64).collect(),
            Value::DoubleArray(numbers) => numbers.clone(),
            _ => Vec::new(),
        };
        for number in numbers {
            if !number.is_finite() {
                return Err(format!("{} = {number} is not a finite number", self.name));
            }
            if let Some(Range { from, to }) = self.range
                && !(from..=to).contains(&number)
            {
                return Err(format!("{} = {number} is outside {from} to {to}", self.name));
            }
        }
        Ok(value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate() -> Parameter {
        Parameter::new("rate", Value::Double(1000.0), "samples per second [Hz]").within(1.0, 2000.0)
    }

    #[test]
    fn whole_numbers_are_doubles_and_ranges_hold() {
        assert_eq!(rate().checked(Value::Integer(500)), Ok(Value::Double(500.0)));
        for wrong in [Value::Double(0.5), Value::Double(f64::NAN), Value::Integer(3000)] {
            assert!(rate().checked(wrong).is_err());
        }
    }

    #[test]
    fn the_type_stays() {
        let refusal = rate().checked(Value::String("fast".into()));
        assert_eq!(refusal, Err("rate is a double, not a string".to_string()));
    }
}
