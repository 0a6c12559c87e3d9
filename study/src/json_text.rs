//! JSON in the format of `--json`.

use serde::Serialize;

use crate::WorkError;

/// A result as JSON text, indented to be readable.
///
/// ```
/// assert_eq!(excavator_study::json_text(&[0.5, 2.0])?, "[\n  0.5,\n  2.0\n]\n");
/// # Ok::<(), excavator_study::WorkError>(())
/// ```
///
/// # Errors
/// [`WorkError::Json`].
pub fn json_text(result: &impl Serialize) -> Result<String, WorkError> {
    Ok(serde_json::to_string_pretty(result)? + "\n")
}
