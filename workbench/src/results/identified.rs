//! Parameters from recordings.

use excavator_identification::identify::{Identified, Method, identify};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::implausible_sentence;

use super::Outcome;
use crate::sentences::{identification_sentence, profile_sentence};
use crate::{WorkError, json_text};

/// Result of `identify`.
pub struct IdentifiedResult {
    /// The model as given.
    pub given: Model,
    /// What was identified.
    pub result: Identified,
}

impl IdentifiedResult {
    /// Identifies the unknown parameters of `model`.
    ///
    /// # Errors
    /// [`WorkError::Identify`].
    pub fn of(model: &Model, recordings: &[&Recording], method: Method) -> Result<Self, WorkError> {
        let mut result = identify(model, recordings, method)?;
        result.add_history(&jiff::Timestamp::now().to_string(), method, recordings);
        Ok(IdentifiedResult { given: model.clone(), result })
    }
}

impl Outcome for IdentifiedResult {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&results::Identification::of(&self.result))
    }

    fn sentence(&self) -> String {
        let profiles = self.result.profiles.iter().map(|profile| profile_sentence(profile, &self.result.model) + ".");
        let all = std::iter::once(identification_sentence(&self.result)).chain(profiles);
        all.chain(implausible_sentence(&self.given, &self.result.model)).collect::<Vec<_>>().join(" ")
    }

    fn model(&self) -> Option<&Model> {
        Some(&self.result.model)
    }
}
