//! Which physical effect a model is missing.

use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{Diagnosis, DiagnosisSettings, diagnose};
use excavator_identification::energy::{EnergySettings, MissingPower, analyse, missing_power};
use excavator_identification::proposal::{Guess, first_guess};
use excavator_identification::report::{diagnosis_page, guess_sentence, verdict_sentence};
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::recording::Recording;
use serde_json::{Value, json};

use super::{Outcome, Progress};
use crate::WorkError;
use crate::json::{diagnosis_json, guess_json, missing_power_json};

/// Result of `diagnose`.
pub struct Diagnosed {
    model: Model,
    diagnosis: Diagnosis,
    guess: Option<Guess>,
    /// What the energy ledger says of each validation recording in which energy is known.
    missing: Vec<(String, Vec<MissingPower>)>,
    validation: Vec<Recording>,
}

impl Diagnosed {
    /// Fits `model` and every effect of its catalogue to `identification`, and takes evidence from `validation`.
    ///
    /// # Errors
    /// [`WorkError::Diagnosis`].
    pub fn of(
        model: &Model,
        identification: &[&Recording],
        validation: Vec<Recording>,
        progress: Progress<'_>,
    ) -> Result<Self, WorkError> {
        let judging: Vec<&Recording> = validation.iter().collect();
        let diagnosis = diagnose(model, identification, &judging, &DiagnosisSettings::default(), progress)?;
        let guess = guess(&diagnosis, identification, &judging);
        let missing = ledgers(&diagnosis.given().fit.model, &judging);
        Ok(Diagnosed { model: model.clone(), diagnosis, guess, missing, validation })
    }
}

/// Where nothing of the catalogue explains the recordings: the term that promises most.
pub fn guess(diagnosis: &Diagnosis, identification: &[&Recording], validation: &[&Recording]) -> Option<Guess> {
    if diagnosis.verdict.kind != Kind::Unexplained {
        return None;
    }
    // Without the signals of an equation there is nothing to guess from; the verdict stands without.
    let settings = DiagnosisSettings::default().effort.fit;
    first_guess(&diagnosis.supported().fit, identification, validation, &settings).ok().flatten()
}

/// What the energy ledger of the refitted model says of each recording in which energy is known.
pub fn ledgers(model: &Model, recordings: &[&Recording]) -> Vec<(String, Vec<MissingPower>)> {
    let analyses = recordings.iter().map(|recording| analyse(model, recording, EnergySettings::default()));
    // Without the pressures there is no ledger; the diagnosis does not need it.
    analyses.flatten().map(|analysis| (analysis.source.clone(), missing_power(model, &analysis))).collect()
}

impl Outcome for Diagnosed {
    fn json(&self) -> Value {
        let mut value = diagnosis_json(&self.model, &self.diagnosis);
        value["first_guess"] = self.guess.as_ref().map_or(Value::Null, guess_json);
        let sentences = |found: &[MissingPower]| found.iter().map(missing_power_json).collect::<Vec<_>>();
        let missing = self.missing.iter().map(|(source, found)| json!({"source": source, "found": sentences(found)}));
        value["missing_power"] = missing.collect();
        value
    }

    fn sentence(&self) -> String {
        let verdict = verdict_sentence(&self.model, &self.diagnosis);
        std::iter::once(verdict).chain(self.guess.iter().map(guess_sentence)).collect::<Vec<_>>().join(" ")
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        let comparisons = self
            .validation
            .iter()
            .map(|recording| compare(&self.diagnosis.given().fit.model, recording))
            .collect::<Result<Vec<Comparison>, _>>()?;
        Ok(Some(diagnosis_page(&self.model, &self.diagnosis, &comparisons, &self.missing)))
    }

    fn model(&self) -> Option<&Model> {
        Some(&self.diagnosis.supported().fit.model)
    }
}
