//! Models by the names that a user gives.

use std::path::Path;

use excavator_model::Model;
use excavator_model::document::{built_in, parse};
use excavator_model::effects::Catalogue;
use rosbag2::{ReadLimits, read_regular_text};

use crate::WorkError;

/// A built-in model, or one from a file, with the effects of a catalogue. A name that ends in `.toml`, or of a file that exists, is a
/// file.
///
/// # Errors
/// [`WorkError::Document`] for an unknown name or a faulty file, [`WorkError::Bag`] if the file cannot be read.
pub fn model_named(name: &str, catalogue: &Catalogue) -> Result<Model, WorkError> {
    let path = Path::new(name);
    if !path.exists() && !name.ends_with(".toml") {
        return Ok(Model { catalogue: catalogue.clone(), ..built_in(name)? });
    }
    let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
    Ok(parse(name, &text, catalogue)?)
}
