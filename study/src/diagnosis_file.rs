//! Reads what `excavator diagnose` wrote: a study, or `--json`.

use std::path::{Path, PathBuf};

use excavator_identification::decision::Kind;
use excavator_identification::design::Sensors;
use excavator_identification::results::{Candidate, Diagnosis, Parameter};
use excavator_model::{Model, ModelError};
use rosbag2::{ReadLimits, read_regular_text};

use crate::WorkError;

/// The parts of a diagnosis that a design needs: rivals by name (`EFFECT@PLACE`, `none`) with the values of all
/// parameters that were fitted with them.
#[derive(Debug)]
pub struct DiagnosisFile {
    path: PathBuf,
    verdict: Kind,
    tied: Vec<String>,
    named: Vec<String>,
    fitted: Vec<(String, Vec<(String, f64)>)>,
    noise: Vec<(String, f64)>,
    nuisances: Vec<String>,
}

impl DiagnosisFile {
    /// Reads a file.
    ///
    /// # Errors
    /// [`WorkError::Bag`], [`WorkError::DiagnosisSyntax`].
    pub fn read(path: &Path) -> Result<Self, WorkError> {
        DiagnosisFile::of_text(path, &read_regular_text(path, ReadLimits::DEFAULT.document)?)
    }

    /// Parses the text of a file. `path` is for error messages.
    ///
    /// # Errors
    /// [`WorkError::DiagnosisSyntax`].
    pub fn of_text(path: &Path, text: &str) -> Result<Self, WorkError> {
        let found = result(text)
            .map_err(|error| WorkError::DiagnosisSyntax { path: path.to_path_buf(), reason: error.to_string() })?;
        let name = |candidate: &Candidate| format!("{}@{}", candidate.effect, candidate.cylinder);
        let mut fitted: Vec<(String, Vec<(String, f64)>)> = vec![("none".into(), values(&found.refitted))];
        fitted.extend(found.candidates.iter().chain(&found.rejected).map(|one| (name(one), values(&one.refitted))));
        Ok(DiagnosisFile {
            path: path.to_path_buf(),
            verdict: found.verdict,
            tied: found.candidates.iter().filter(|candidate| candidate.tied_with_first).map(name).collect(),
            named: found.candidates.iter().map(name).collect(),
            fitted,
            nuisances: found.nuisances.iter().map(|one| format!("{}@{}", one.effect, one.cylinder)).collect(),
            noise: found.instruments.into_iter().filter_map(|one| Some((one.name, one.noise?))).collect(),
        })
    }

    /// Names of the tied candidates, best first.
    ///
    /// # Errors
    /// [`WorkError::NoTie`] when there are fewer than two.
    pub fn tied(&self) -> Result<Vec<String>, WorkError> {
        if self.tied.len() > 1 {
            return Ok(self.tied.clone());
        }
        let found = match self.named.as_slice() {
            [] => format!("its verdict is {} without a candidate", self.verdict.name()),
            named => format!("it names {} without an alternative", named.join(", ")),
        };
        Err(WorkError::NoTie { path: self.path.clone(), found })
    }

    /// Whether the diagnosis has fitted values for a rival.
    pub fn has(&self, rival: &str) -> bool {
        !self.values(rival).is_empty()
    }

    /// Contract names and values of the parameters fitted with a rival; empty if there are none.
    pub fn values(&self, rival: &str) -> &[(String, f64)] {
        self.fitted.iter().find(|(name, _)| name == rival).map_or(&[], |(_, values)| values)
    }

    /// `model` with the estimated nuisance effects, since rivals with values from the diagnosis include them.
    ///
    /// # Errors
    /// [`ModelError`] if the model has no such place.
    pub fn with_nuisances(&self, model: &Model) -> Result<Model, ModelError> {
        let mut extended = model.clone();
        for name in &self.nuisances {
            for (physics, site) in model.parse_addition(name)? {
                if !model.has(&physics.card().name, site) {
                    extended = extended.with_effect(&physics, site)?;
                }
            }
        }
        Ok(extended)
    }

    /// Replaces the usual sensor noise by that of the diagnosis, if the diagnosis has it.
    pub fn noise_into(&self, sensors: &mut Sensors) {
        if !self.noise.is_empty() {
            sensors.noise.clone_from(&self.noise);
        }
    }
}

/// The result of a study, or the result itself.
fn result(text: &str) -> Result<Diagnosis, serde_json::Error> {
    #[derive(serde::Deserialize)]
    struct OfStudy {
        result: Option<Diagnosis>,
    }
    match serde_json::from_str::<OfStudy>(text)?.result {
        Some(result) => Ok(result),
        None => serde_json::from_str(text),
    }
}

fn values(list: &[Parameter]) -> Vec<(String, f64)> {
    list.iter().filter_map(|one| Some((one.name.clone(), one.value?))).collect()
}
