//! Diagnosis of the physical effect that a model is missing.

use excavator_identification::diagnosis::{Diagnosis, DiagnosisSettings, diagnose};
use excavator_identification::energy::{MissingPower, ledgers};
use excavator_identification::proposal::{Guess, guess_for};
use excavator_identification::results;
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::{diagnosis_page, guess_sentence, verdict_sentence};

use super::{Outcome, Progress};
use crate::{WorkError, json_text};

/// Result of `diagnose`.
pub struct Diagnosed {
    /// The model as given.
    pub model: Model,
    /// Verdict and candidates.
    pub diagnosis: Diagnosis,
    /// A first guess at the law, if no effect explains the difference.
    pub guess: Option<Guess>,
    /// Missing power in the energy ledger of each validation recording with known energy.
    pub missing: Vec<(String, Vec<MissingPower>)>,
    /// The recordings that provide the evidence.
    pub validation: Vec<Recording>,
}

impl Diagnosed {
    /// Fits `model` and every effect of its catalogue to `identification`, and evaluates the evidence on `validation`.
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
        let guess = guess_for(&diagnosis, identification, &judging);
        let missing = ledgers(&diagnosis.given().fit.model, &judging);
        Ok(Diagnosed { model: model.clone(), diagnosis, guess, missing, validation })
    }
}

impl Outcome for Diagnosed {
    fn json(&self) -> Result<String, WorkError> {
        let result = results::Diagnosis::of(&self.model, &self.diagnosis, self.guess.as_ref(), &self.missing);
        json_text(&result)
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
