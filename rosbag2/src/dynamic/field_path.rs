//! Field paths in text form: `position[name=arm]`, `data[3]`, `pose.position.x`.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::error::PathError;

/// Which element of an array.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Index {
    /// By number, from 0.
    Number(usize),
    /// `[key=value]`: the element whose field `key` is the text `value`. If the array has a sibling list of texts
    /// `key`, the element at the position of `value` in that list (as in `sensor_msgs/JointState`). The key may lead into
    /// structs: `array[header.frame_id=arm]`, `data[layout.dim.label=arm]`.
    Named {
        /// Name of the field.
        key: String,
        /// Its content.
        value: String,
    },
}

/// One field of a path.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Step {
    /// Name of the field.
    pub field: String,
    /// Which element, if it is an array.
    pub index: Option<Index>,
}

/// The way from a message to one number in it.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct FieldPath {
    /// At least one.
    steps: Vec<Step>,
}

impl FieldPath {
    /// The fields from the message to the number; at least one.
    pub fn steps(&self) -> &[Step] {
        &self.steps
    }

    /// The path with these steps; `None` without any.
    pub fn from_steps(steps: Vec<Step>) -> Option<FieldPath> {
        (!steps.is_empty()).then_some(FieldPath { steps })
    }
}

impl FromStr for FieldPath {
    type Err = PathError;

    fn from_str(text: &str) -> Result<Self, PathError> {
        let wrong = |reason: &str| PathError::Syntax { path: text.to_string(), reason: reason.to_string() };
        let mut steps = Vec::new();
        let mut rest = text.trim();
        loop {
            let end = rest.find(['.', '[']).unwrap_or(rest.len());
            let (field, after) = rest.split_at(end);
            if field.is_empty() || field.contains(|c: char| c.is_whitespace() || c == ']' || c == '=') {
                return Err(wrong("a field has no valid name"));
            }
            rest = after;
            let mut index = None;
            if let Some(after) = rest.strip_prefix('[') {
                let (inner, after) = after.split_once(']').ok_or_else(|| wrong("a bracket is not closed"))?;
                rest = after;
                index = Some(match inner.split_once('=') {
                    Some((key, value)) if !key.trim().is_empty() => {
                        Index::Named { key: key.trim().to_string(), value: value.trim().to_string() }
                    }
                    Some(_) => return Err(wrong("there is no name before the =")),
                    None => Index::Number(inner.trim().parse().map_err(|_| wrong("an index must be a number"))?),
                });
            }
            steps.push(Step { field: field.to_string(), index });
            match rest.strip_prefix('.') {
                Some(after) => rest = after,
                None if rest.is_empty() => return Ok(FieldPath { steps }),
                None => return Err(wrong("expected a dot or the end after an index")),
            }
        }
    }
}

impl fmt::Display for FieldPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, step) in self.steps.iter().enumerate() {
            let dot = if number == 0 { "" } else { "." };
            write!(f, "{dot}{}", step.field)?;
            match &step.index {
                Some(Index::Number(index)) => write!(f, "[{index}]")?,
                Some(Index::Named { key, value }) => write!(f, "[{key}={value}]")?,
                None => {}
            }
        }
        Ok(())
    }
}

impl TryFrom<String> for FieldPath {
    type Error = PathError;

    fn try_from(text: String) -> Result<Self, PathError> {
        text.parse()
    }
}

impl From<FieldPath> for String {
    fn from(path: FieldPath) -> String {
        path.to_string()
    }
}
