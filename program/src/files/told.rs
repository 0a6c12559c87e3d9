//! Writes the report page and the JSON of a result.

use std::path::Path;

use excavator_study::results::Outcome;

use super::write;
use crate::cli::Overwriting;
use crate::error::VerbError;

/// Writes a result to the files of `--report` and `--json`, if given.
///
/// # Errors
/// The errors of [`write`]; [`VerbError::Work`] and similar if the page needs a simulation that fails.
pub fn write_told(
    told: &impl Outcome,
    report: Option<&Path>,
    json: Option<&Path>,
    overwriting: Overwriting,
) -> Result<(), VerbError> {
    if let Some(path) = report
        && let Some(page) = told.page()?
    {
        write(path, &page, overwriting)?;
    }
    if let Some(path) = json {
        write(path, &told.json()?, overwriting)?;
    }
    Ok(())
}
