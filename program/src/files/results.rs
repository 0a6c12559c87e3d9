//! Results in files: a page, and JSON.

use std::path::Path;

use excavator_study::json_text;
use excavator_study::results::Outcome;
use serde::Serialize;
use serde_json::{Value, json};

use super::write;
use crate::cli::{Overwriting, ResultFile};
use crate::error::VerbError;

/// Writes a result to the files of `--report` and `--json`, if given.
///
/// # Errors
/// The errors of [`write`]; [`VerbError::Study`] if the page needs a simulation that fails.
pub fn write_told(told: &impl Outcome, report: Option<&Path>, result: &ResultFile) -> Result<(), VerbError> {
    write_page(told, report, result.overwriting)?;
    result.json.as_deref().map_or(Ok(()), |path| write(path, &told.json()?, result.overwriting))
}

/// Writes the page of a result to the file of `--report`, if given.
///
/// # Errors
/// As [`write_told`].
pub fn write_page(told: &impl Outcome, report: Option<&Path>, overwriting: Overwriting) -> Result<(), VerbError> {
    let Some(path) = report else { return Ok(()) };
    told.page()?.map_or(Ok(()), |page| write(path, &page, overwriting))
}

/// Writes a result to the file of `--json`, if given.
///
/// # Errors
/// The errors of [`write`].
pub fn write_json(content: &impl Serialize, result: &ResultFile) -> Result<(), VerbError> {
    result.json.as_deref().map_or(Ok(()), |path| write(path, &json_text(content)?, result.overwriting))
}

/// JSON has no NaN: a value that is not finite becomes null.
pub fn finite(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}
