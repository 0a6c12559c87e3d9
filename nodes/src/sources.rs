//! Models and recordings by what a person calls them.

use std::path::Path;

use excavator_bags::map::read_recording_or_mapped;
use excavator_identification::gate;
use excavator_model::Model;
use excavator_model::document::{built_in, parse};
use excavator_model::recording::Recording;

use crate::cli::Mapping;
use crate::error::VerbError;

/// A model by its built-in name or file.
pub fn model(name: &str) -> Result<Model, VerbError> {
    let path = Path::new(name);
    if !path.exists() && !name.ends_with(".toml") {
        return Ok(built_in(name)?);
    }
    let text = std::fs::read_to_string(path).map_err(|source| VerbError::Read { path: path.to_path_buf(), source })?;
    Ok(parse(name, &text)?)
}

/// A recording, with what was wrong in its data told on standard error, checked against the model. Bags of other people
/// and tables are read through `map`, or the map that lies beside them.
pub fn recording(path: &Path, map: &Mapping, model: &Model) -> Result<Recording, VerbError> {
    let (recording, report) = read_recording_or_mapped(path, map.map.as_deref())?;
    for problem in report.problems() {
        eprintln!("{}: {problem}", path.display());
    }
    gate::check(model, &recording)?;
    Ok(recording)
}

/// Several recordings.
pub fn recordings(paths: &[impl AsRef<Path>], map: &Mapping, model: &Model) -> Result<Vec<Recording>, VerbError> {
    paths.iter().map(|path| recording(path.as_ref(), map, model)).collect()
}

/// Writes a text file.
pub fn write_text(path: &Path, text: &str) -> Result<(), VerbError> {
    std::fs::write(path, text).map_err(|source| VerbError::Write { path: path.to_path_buf(), source })
}
