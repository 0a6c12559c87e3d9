//! Parameters from recordings.

use excavator_identification::report::implausible_sentence;
use excavator_model::Model;
use excavator_model::recording::Recording;
use serde_json::Value;

use super::Outcome;
use crate::WorkError;
use crate::identified::{Identified, Method, identify, note, profile_sentence, summary};
use crate::json::identified_json;

/// Result of `identify`.
pub struct IdentifiedResult {
    given: Model,
    result: Identified,
}

impl IdentifiedResult {
    /// Identifies the unknown parameters of `model`.
    ///
    /// # Errors
    /// [`WorkError::Regression`], [`WorkError::Fit`].
    pub fn of(model: &Model, recordings: &[&Recording], method: Method) -> Result<Self, WorkError> {
        let mut result = identify(model, recordings, method)?;
        note(&mut result, method, recordings);
        Ok(IdentifiedResult { given: model.clone(), result })
    }
}

impl Outcome for IdentifiedResult {
    fn json(&self) -> Value {
        identified_json(&self.result)
    }

    fn sentence(&self) -> String {
        let profiles = self.result.profiles.iter().map(|profile| profile_sentence(profile, &self.result.model) + ".");
        let all = std::iter::once(summary(&self.result)).chain(profiles);
        all.chain(implausible_sentence(&self.given, &self.result.model)).collect::<Vec<_>>().join(" ")
    }

    fn model(&self) -> Option<&Model> {
        Some(&self.result.model)
    }
}
