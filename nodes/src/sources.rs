//! Finds models and recordings by the names that a user gives.

use std::path::{Path, PathBuf};

use excavator_bags::ReadReport;
use excavator_bags::map::read_recording_or_mapped;
use excavator_identification::checks;
use excavator_model::Model;
use excavator_model::document::{built_in, parse, parse_catalogue};
use excavator_model::effects::Catalogue;
use excavator_model::recording::Recording;
#[cfg(feature = "live")]
use excavator_ros::{Parameter, Value};
use excavator_workbench::recording_part::Part;
use excavator_workbench::recordings::{Use, checked as fit_for_use, choice};
use rosbag2::{ReadLimits, read_regular_text};

use crate::cli::{self, Extent, Mapping};
use crate::error::VerbError;
use crate::long_recording::recording_or_stretches;
use crate::terminal::remark;

/// A model by its built-in name or file, with the user's own effects.
pub fn model(choice: &cli::ModelChoice) -> Result<Model, VerbError> {
    model_with(&choice.model, &catalogue(&choice.own)?)
}

/// A second model, with the catalogues of the first.
pub fn another_model(name: &str, first: &cli::ModelChoice) -> Result<Model, VerbError> {
    model_with(name, &catalogue(&first.own)?)
}

/// The parameter that names a node's model, if the node does not use the published one.
#[cfg(feature = "live")]
pub fn model_parameter() -> Parameter {
    let meaning = "built-in model or model file (.toml); empty: the model on arm/model";
    Parameter::new("model", Value::String(String::new()), meaning).read_only()
}

/// Like `model`, with the effects of the program and of the model's own file.
#[cfg(feature = "live")]
pub fn model_named(name: &str) -> Result<Model, VerbError> {
    model_with(name, &Catalogue::built_in())
}

fn model_with(name: &str, catalogue: &Catalogue) -> Result<Model, VerbError> {
    let path = Path::new(name);
    if !path.exists() && !name.ends_with(".toml") {
        return Ok(Model { catalogue: catalogue.clone(), ..built_in(name)? });
    }
    let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
    Ok(parse(name, &text, catalogue)?)
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

/// A recording, checked against the model. Problems in its data are reported on standard error. Foreign bags and tables are
/// read through `map`, or through the map file beside them. `BAG@20..40` is the part from 20 s to 40 s.
pub fn recording(path: &Path, map: &Mapping, model: &Model) -> Result<Recording, VerbError> {
    let (whole, part) = Part::split(path)?;
    let (mut recording, report) = read_recording_or_mapped(&whole, map.origin())?;
    if let Some(part) = part {
        recording = part.of(&recording, path)?;
    }
    checked(path, recording, &report, map, model)
}

/// As [`recording`]. Of a long recording only the stretches most informative about the parameters of `model` are read, unless
/// `extent` asks for all of it. The selection is reported on standard error.
pub fn telling_recording(path: &Path, extent: Extent, map: &Mapping, model: &Model) -> Result<Recording, VerbError> {
    if extent.whole {
        return recording(path, map, model);
    }
    let (recording, report, chosen) = recording_or_stretches(path, map.origin(), model)?;
    if let Some(chosen) = &chosen {
        remark(&format!("{}: {}; --whole uses all", path.display(), choice(&recording, chosen)));
    }
    checked(path, recording, &report, map, model)
}

/// Checks a recording before use and prints the remarks on standard error.
fn checked(
    path: &Path,
    recording: Recording,
    report: &ReadReport,
    map: &Mapping,
    model: &Model,
) -> Result<Recording, VerbError> {
    let name = path.display().to_string();
    report.problems().iter().for_each(|problem| remark(&format!("{name}: {problem}")));
    let usage = Use { accept: &map.accept, conditions: &map.conditions };
    let mut remarks = Vec::new();
    let used = fit_for_use(&name, recording, report, &usage, model, &mut remarks);
    // Also print the remarks that precede a failure.
    remarks.iter().for_each(|line| remark(line));
    Ok(used?)
}

/// Several recordings.
pub fn recordings(paths: &[impl AsRef<Path>], map: &Mapping, model: &Model) -> Result<Vec<Recording>, VerbError> {
    paths.iter().map(|path| recording(path.as_ref(), map, model)).collect()
}

/// Several recordings. Of long ones, the most informative stretches.
pub fn telling_recordings(
    paths: &[impl AsRef<Path>],
    extent: Extent,
    map: &Mapping,
    model: &Model,
) -> Result<Vec<Recording>, VerbError> {
    paths.iter().map(|path| telling_recording(path.as_ref(), extent, map, model)).collect()
}

/// The recordings for the fit and those for validation. What they have in common is reported on standard error.
pub fn fitted_and_judging(
    paths: &cli::Recordings,
    model: &Model,
) -> Result<(Vec<Recording>, Vec<Recording>), VerbError> {
    let identification = telling_recordings(&paths.identification, paths.extent, &paths.mapping, model)?;
    let validation = telling_recordings(&paths.validation, paths.extent, &paths.mapping, model)?;
    let (fitted, judging): (Vec<_>, Vec<_>) = (identification.iter().collect(), validation.iter().collect());
    for shared in checks::shared_readings(&fitted, &judging) {
        remark(&shared.to_string());
    }
    Ok((identification, validation))
}
