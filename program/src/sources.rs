//! Finds models by the names that a user gives.

use std::path::{Path, PathBuf};

use excavator_model::Model;
use excavator_model::document::parse_catalogue;
use excavator_model::effects::Catalogue;
use excavator_study::model_named;
use rosbag2::{ReadLimits, read_regular_text};

use crate::cli;
use crate::error::VerbError;

/// A model by its built-in name or file, with the user's own effects.
pub fn model(choice: &cli::ModelChoice) -> Result<Model, VerbError> {
    Ok(model_named(&choice.model, &catalogue(&choice.own)?)?)
}

/// A second model, with the catalogues of the first.
pub fn another_model(name: &str, first: &cli::ModelChoice) -> Result<Model, VerbError> {
    Ok(model_named(name, &catalogue(&first.own)?)?)
}

/// The effects of the program and of these catalogue files. Of a folder, every TOML file is read, sorted by name.
pub fn catalogue(own: &cli::OwnEffects) -> Result<Catalogue, VerbError> {
    let mut catalogue = Catalogue::built_in();
    for path in &own.catalogue {
        let files = if path.is_dir() { catalogue_files(path)? } else { vec![path.clone()] };
        for file in files {
            let text = read_regular_text(&file, ReadLimits::DEFAULT.document)?;
            catalogue = parse_catalogue(&file.display().to_string(), &text, &catalogue)?;
        }
    }
    Ok(catalogue)
}

fn catalogue_files(folder: &Path) -> Result<Vec<PathBuf>, VerbError> {
    let unusable = |reason: String| VerbError::Catalogue { path: folder.to_path_buf(), reason };
    let entries = std::fs::read_dir(folder).map_err(|error| unusable(error.to_string()))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    if files.is_empty() {
        return Err(unusable("the folder has no catalogue files (.toml)".to_string()));
    }
    Ok(files)
}
