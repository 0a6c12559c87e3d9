//! A diagnosis on disk, with the models that it fitted: `diagnose --save`, `refine --diagnosis`.

use std::path::{Path, PathBuf};

use excavator_identification::decision::Kind;
use excavator_identification::refinement::Refinement;
use excavator_model::Model;
use excavator_model::document::{self, to_text};
use excavator_model::effects::Catalogue;
use excavator_report::refinement_sentence;
use excavator_workbench::WorkError;
use rosbag2::{ReadLimits, read_regular_text};
use serde::{Deserialize, Serialize};

use crate::cli::{Extent, Mapping, Recordings};
use crate::error::VerbError;

/// Version of the file format. A file with another version is rejected.
const FORM: u32 = 1;

/// What `diagnose --save` writes.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SavedDiagnosis {
    form: u32,
    /// What is to be thought of the given model.
    pub verdict: Kind,
    /// The verdict in words.
    pub sentence: String,
    /// The model as it was given, TOML.
    given: String,
    /// The models on the way to the one that the verdict supports.
    steps: Vec<SavedStep>,
    /// The last of them with its history, TOML.
    refined: String,
    identification: Vec<PathBuf>,
    validation: Vec<PathBuf>,
    map: Option<PathBuf>,
    namespace: Option<String>,
    accept: Vec<String>,
    conditions: Vec<String>,
    whole: bool,
}

/// A model on the way.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct SavedStep {
    /// What was added last, `effect@place`; `None` for the given model, refitted.
    added: Option<String>,
    /// TOML.
    model: String,
}

/// An intermediate model, read back from the file.
#[derive(Debug, Clone)]
pub struct ModelStep {
    /// What was added last, `effect@place`; `None` for the given model, refitted.
    pub added: Option<String>,
    /// The model.
    pub model: Model,
}

impl SavedDiagnosis {
    /// Builds the file content from a refinement that followed a diagnosis.
    ///
    /// # Errors
    /// [`VerbError`] if a model cannot be written as text.
    pub fn of(refinement: &Refinement, recordings: &Recordings) -> Result<Self, VerbError> {
        let steps = refinement
            .steps
            .iter()
            .map(|step| Ok(SavedStep { added: step.added.clone(), model: to_text(&step.fit.model)? }))
            .collect::<Result<_, VerbError>>()?;
        let mapping = &recordings.mapping;
        Ok(SavedDiagnosis {
            form: FORM,
            verdict: refinement.verdict(),
            sentence: refinement_sentence(refinement),
            given: to_text(&refinement.given_model)?,
            steps,
            refined: to_text(&refinement.model)?,
            identification: recordings.identification.clone(),
            validation: recordings.validation.clone(),
            map: mapping.map.clone(),
            namespace: mapping.namespace.clone(),
            accept: mapping.accept.clone(),
            conditions: mapping.conditions.clone(),
            whole: recordings.extent.whole,
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`VerbError::Bag`], [`WorkError::DiagnosisSyntax`].
    pub fn read(path: &Path) -> Result<Self, VerbError> {
        let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
        let wrong = |reason: String| WorkError::DiagnosisSyntax { path: path.to_path_buf(), reason };
        let saved: SavedDiagnosis = serde_json::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        if saved.form == FORM {
            Ok(saved)
        } else {
            Err(wrong(format!("it has form {}, this program reads form {FORM}; run diagnose --save again", saved.form))
                .into())
        }
    }

    /// The file's text.
    ///
    /// # Errors
    /// [`VerbError::Json`].
    pub fn text(&self) -> Result<String, VerbError> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// The recordings of the diagnosis.
    pub fn recordings(&self) -> Recordings {
        Recordings {
            identification: self.identification.clone(),
            validation: self.validation.clone(),
            mapping: Mapping {
                map: self.map.clone(),
                namespace: self.namespace.clone(),
                accept: self.accept.clone(),
                conditions: self.conditions.clone(),
            },
            extent: Extent { whole: self.whole },
        }
    }

    /// The model as it was given.
    ///
    /// # Errors
    /// [`VerbError`] if its text cannot be parsed.
    pub fn given(&self) -> Result<Model, VerbError> {
        model_of("given", &self.given)
    }

    /// The intermediate models up to the refined one.
    ///
    /// # Errors
    /// [`VerbError`] if a text cannot be parsed.
    pub fn steps(&self) -> Result<Vec<ModelStep>, VerbError> {
        let step =
            |step: &SavedStep| Ok(ModelStep { added: step.added.clone(), model: model_of("step", &step.model)? });
        self.steps.iter().map(step).collect()
    }

    /// The refined model, with its history.
    ///
    /// # Errors
    /// [`VerbError`] if its text cannot be parsed.
    pub fn refined(&self) -> Result<Model, VerbError> {
        model_of("refined", &self.refined)
    }
}

fn model_of(name: &str, text: &str) -> Result<Model, VerbError> {
    Ok(document::parse(name, text, &Catalogue::built_in())?)
}
