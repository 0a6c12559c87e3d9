//! Diagnosis of the physical effect that a model is missing.

use excavator_identification::diagnosis::{Diagnosis, diagnose};
use excavator_identification::energy::{MissingPower, ledgers};
use excavator_identification::proposal::{Guess, guess_for};
use excavator_identification::refinement::refinement_of;
use excavator_identification::results;
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::{diagnosis_page, guess_sentence, verdict_sentence};

use super::{Outcome, Progress, Refined};
use crate::{Study, WorkError, json_text};

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

impl Study {
    /// Fits the model and every effect of its catalogue to the identification recordings, and evaluates the evidence on the
    /// validation recordings.
    ///
    /// # Errors
    /// [`WorkError::Diagnosis`].
    pub fn diagnose(self, progress: Progress<'_>) -> Result<Diagnosed, WorkError> {
        let (fitted, judging) = (self.fitted(), self.judging());
        let mut diagnosis = diagnose(&self.model, &fitted, &judging, &self.settings, progress)?;
        diagnosis.lost_messages = self.lost_messages.clone();
        let guess = guess_for(&diagnosis, &fitted, &judging);
        let missing = ledgers(&diagnosis.given().fit.model, &judging);
        Ok(Diagnosed { diagnosis, guess, missing, model: self.model, validation: self.validation })
    }
}

impl Diagnosed {
    /// The result for JSON.
    pub fn result(&self) -> results::Diagnosis {
        results::Diagnosis::of(&self.model, &self.diagnosis, self.guess.as_ref(), &self.missing)
    }

    /// The refinement that adds what was found, without another search. `fitted_to` names the identification recordings.
    ///
    /// # Errors
    /// [`WorkError::Refine`].
    pub fn refine(self, fitted_to: &[String]) -> Result<Refined, WorkError> {
        let (judging, when) = (self.validation.iter().collect::<Vec<_>>(), jiff::Timestamp::now().to_string());
        Ok(Refined { refinement: refinement_of(&self.model, self.diagnosis, fitted_to, &judging, &when)? })
    }
}

impl Outcome for Diagnosed {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&self.result())
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
