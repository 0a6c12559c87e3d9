//! Results as JSON.

use std::path::Path;

use excavator_study::json_text;
use serde::Serialize;
use serde_json::{Value, json};

use crate::cli::Overwriting;
use crate::error::VerbError;

/// Writes a result as JSON to a file, or to standard output for "-".
pub fn write_json(path: &Path, result: &impl Serialize, overwriting: Overwriting) -> Result<(), VerbError> {
    super::write(path, &json_text(result)?, overwriting)
}

/// JSON has no NaN: a value that is not finite becomes null.
pub fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}
