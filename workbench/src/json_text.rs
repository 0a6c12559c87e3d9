//! JSON as `--json` has it.

use serde::Serialize;

use crate::WorkError;

/// A result as text, laid out for people too.
///
/// # Errors
/// [`WorkError::Json`].
pub fn json_text(result: &impl Serialize) -> Result<String, WorkError> {
    Ok(serde_json::to_string_pretty(result)? + "\n")
}
