//! A study on disk: `diagnose --save` writes it; `refine`, `design`, `report` and replays continue from it.

use std::path::{Path, PathBuf};

use excavator_identification::decision::Scores;
use excavator_identification::diagnosis::DiagnosisRecord;
use excavator_identification::energy::MissingPower;
use excavator_identification::proposal::Guess;
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::document::{parse, to_text};
use excavator_model::effects::{AnyEffect, Catalogue};
use excavator_model::formula::{FormulaText, Law};
use rosbag2::{ReadLimits, read_regular_text};
use serde::{Deserialize, Serialize};

use crate::WorkError;
use crate::recording_files::RecordingFile;
use crate::results::Diagnosed;

/// Version of the file. A file of another version is refused.
const VERSION: u32 = 2;

/// A study with its diagnosis.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StudyFile {
    study: u32,
    /// Version of the program that wrote it.
    program: String,
    /// What was diagnosed, and with which options.
    pub options: StudyOptions,
    /// Recordings that parameters were fitted to.
    pub identification: Vec<RecordingFile>,
    /// Recordings that evidence was taken from.
    pub validation: Vec<RecordingFile>,
    /// The model as given, TOML.
    model: String,
    /// The user's own effects that were tried, and that the model does not have.
    catalogue: Vec<FormulaText>,
    /// The result, as `diagnose --json` writes it.
    result: results::Diagnosis,
    diagnosis: DiagnosisRecord,
    guess: Option<Guess>,
    missing_power: Vec<(String, Vec<MissingPower>)>,
}

/// How the model and the recordings of a study were named.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StudyOptions {
    /// Built-in name or file of the model.
    pub model: String,
    /// Catalogue files and folders.
    pub catalogue: Vec<PathBuf>,
    /// Map of the recordings.
    pub map: Option<PathBuf>,
    /// Namespace of the machine.
    pub namespace: Option<String>,
    /// Checks that were overruled.
    pub accept: Vec<String>,
    /// Conditions under which the recordings were compared.
    pub conditions: Vec<String>,
    /// Whether long recordings were used whole.
    pub whole: bool,
}

impl StudyFile {
    /// Of a diagnosis.
    ///
    /// # Errors
    /// [`WorkError::Document`] if the model cannot be written, [`WorkError::Bag`] if a recording cannot be read again.
    pub fn of(
        diagnosed: &Diagnosed,
        options: StudyOptions,
        [identification, validation]: [&[PathBuf]; 2],
    ) -> Result<Self, WorkError> {
        let model = &diagnosed.model;
        let files = |paths: &[PathBuf]| paths.iter().map(|path| RecordingFile::of(path)).collect::<Result<_, _>>();
        Ok(StudyFile {
            study: VERSION,
            program: env!("CARGO_PKG_VERSION").to_string(),
            options,
            identification: files(identification)?,
            validation: files(validation)?,
            model: to_text(model)?,
            catalogue: own_effects(model),
            result: diagnosed.result(),
            diagnosis: DiagnosisRecord::of(&diagnosed.diagnosis),
            guess: diagnosed.guess.clone(),
            missing_power: diagnosed.missing.clone(),
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`WorkError::Bag`] if it cannot be read, [`WorkError::StudySyntax`] if it is no study of this version.
    pub fn read(path: &Path) -> Result<Self, WorkError> {
        #[derive(Deserialize)]
        struct Version {
            study: Option<u32>,
        }
        let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
        let wrong = |reason: String| WorkError::StudySyntax { path: path.to_path_buf(), reason };
        let version: Version = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        match version.study {
            Some(VERSION) => serde_json::from_str(&text).map_err(|error| wrong(error.to_string())),
            Some(other) => Err(wrong(format!(
                "it has version {other}, this program reads version {VERSION}; run `excavator diagnose --save` again"
            ))),
            None => Err(wrong("it has no version; run `excavator diagnose --save` again".to_string())),
        }
    }

    /// The file's text.
    ///
    /// # Errors
    /// [`WorkError::Json`].
    pub fn text(&self) -> Result<String, WorkError> {
        Ok(serde_json::to_string(self)? + "\n")
    }

    /// What the verdict was decided from.
    pub fn scores(&self) -> &Scores {
        self.diagnosis.scores()
    }

    /// The result, as `diagnose --json` writes it.
    pub fn result(&self) -> &results::Diagnosis {
        &self.result
    }

    /// The diagnosis, without its recordings.
    ///
    /// # Errors
    /// [`WorkError::Document`], [`WorkError::Model`] or [`WorkError::StudySyntax`] if the file was changed, or if an effect was no
    /// formula and is not part of this program.
    pub fn diagnosed(self, path: &Path) -> Result<Diagnosed, WorkError> {
        let wrong = |reason: String| WorkError::StudySyntax { path: path.to_path_buf(), reason };
        let own = self.catalogue.iter().map(|text| Ok(std::sync::Arc::new(Law::read(text)?) as AnyEffect));
        let own: Vec<AnyEffect> =
            own.collect::<Result<_, excavator_model::formula::LawError>>().map_err(|error| wrong(error.to_string()))?;
        let catalogue = Catalogue::built_in().with(own).map_err(|error| wrong(error.to_string()))?;
        let model = parse(&path.display().to_string(), &self.model, &catalogue)?;
        let diagnosis = self.diagnosis.diagnosis(&model).map_err(|error| wrong(error.to_string()))?;
        Ok(Diagnosed { model, diagnosis, guess: self.guess, missing: self.missing_power, validation: Vec::new() })
    }
}

/// Formulas in the catalogue of a model that neither the program nor the model itself has.
fn own_effects(model: &Model) -> Vec<FormulaText> {
    let built_in = Catalogue::built_in();
    let is_known = |name: &str| built_in.find(name).is_ok() || model.effects.iter().any(|effect| effect.name() == name);
    let own = model.catalogue.iter().filter(|effect| !is_known(&effect.card().name));
    own.filter_map(|effect| effect.formula().cloned()).collect()
}
