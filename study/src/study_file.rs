//! A study on disk: `diagnose --save` writes it; `refine`, `design`, `report` and replays continue from it.

use std::path::{Path, PathBuf};

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
    /// Whether the time that a piston spends at a stop is left out.
    #[serde(default)]
    pub leave_out_stops: bool,
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;
    use excavator_model::effects::Site;
    use excavator_model::recording::Recording;
    use excavator_model::simulation::{Tolerances, simulate_from_rest};
    use tempfile::TempDir;

    use super::*;
    use crate::Study;
    use crate::results::Outcome;

    /// A swing of an arm whose valve has a dead zone, and the model without it. The catalogue has little besides.
    fn study() -> Study {
        let mut model = built_in("zx30u-arm").unwrap();
        let wanted = ["valve_dead_zone", "valve_directional_gain"];
        let few = model.catalogue.iter().filter(|effect| {
            let card = effect.card();
            let is_used = model.effects.iter().any(|own| own.name() == card.name);
            is_used || !card.family.is_candidate() || wanted.contains(&&*card.name)
        });
        model.catalogue = Catalogue::of(few.cloned().collect());
        let mut machine =
            model.with_effect(&model.catalogue.find("valve_dead_zone").unwrap(), Site::Cylinder(0)).unwrap();
        machine.effects.last_mut().unwrap().parameters.iter_mut().for_each(|parameter| parameter.value = 8e-6);
        let recording = |shift: f64| {
            let time: Vec<f64> = (0..6000).map(|sample| f64::from(sample) * 2e-3).collect();
            let mut command = Recording::unmeasured("swing", time, &["arm"]);
            command.tank_pressure.fill(3e5);
            let area = |t: &f64| 5e-5 * (3.1 * t + shift).sin() + 3e-5 * (7.3 * t).sin();
            command.cylinders[0].orifice_area = command.time.iter().map(area).collect();
            simulate_from_rest(&machine, &command, &[0.1], Tolerances::default()).unwrap()
        };
        Study::new(model, vec![recording(0.0)], vec![recording(1.0)])
    }

    fn saved(folder: &TempDir, text: &str) -> PathBuf {
        let path = folder.path().join("study.json");
        std::fs::write(&path, text).unwrap();
        path
    }

    #[test]
    fn a_study_gives_the_same_bytes_again() {
        let folder = tempfile::tempdir().unwrap();
        let lost = "8 of 240 messages of /arm/state were lost";
        let study = Study { lost_messages: vec![lost.to_string()], ..study() };
        let diagnosed = study.diagnose(&|_, _| ()).unwrap();
        assert!(diagnosed.sentence().contains(&format!("The verdict rests on signals with losses: {lost}.")));
        let bag = saved(&folder, "the recording");
        let file = StudyFile::of(&diagnosed, StudyOptions::default(), [&[], &[bag]]).unwrap();
        let path = saved(&folder, &file.text().unwrap());
        let mut read = StudyFile::read(&path).unwrap().diagnosed(&path).unwrap();
        assert_eq!(diagnosed.result().effects.len(), 1, "{}", diagnosed.sentence());
        assert_eq!(read.json().unwrap(), diagnosed.json().unwrap());
        assert_eq!(read.sentence(), diagnosed.sentence());
        read.validation.clone_from(&diagnosed.validation);
        assert!(read.page().unwrap() == diagnosed.page().unwrap(), "the pages differ");
    }

    #[test]
    fn what_is_no_study_is_refused_in_one_line() {
        let folder = tempfile::tempdir().unwrap();
        let refused = |text: &str| StudyFile::read(&saved(&folder, text)).unwrap_err().to_string();
        assert!(refused("{\"form\": 1}").contains("it has no version; run `excavator diagnose --save` again"));
        assert!(refused("{\"study\": 1}").contains("it has version 1, this program reads version 2"));
        assert!(refused("{\"study\": 2}").contains("is no study: missing field"));
        assert!(refused("[").contains("is no study: EOF"));
    }
}
