//! Parameters from recordings.

use excavator_identification::fit::Watch;
use excavator_identification::identify::{Identified, Method, identify_watched};
use excavator_identification::results;
use excavator_model::Model;
use excavator_report::implausible_sentence;

use super::Outcome;
use crate::sentences::{identification_sentence, profile_sentence};
use crate::{Study, WorkError, json_text};

/// Result of `identify`.
pub struct IdentifiedResult {
    /// The model as given.
    pub given: Model,
    /// What was identified.
    pub result: Identified,
}

impl Study {
    /// Identifies the unknown parameters of the model from the identification recordings. `watch` receives the progress, and can
    /// stop the work.
    ///
    /// # Errors
    /// [`WorkError::Identify`].
    pub fn identify(&self, method: Method, watch: Watch<'_>) -> Result<IdentifiedResult, WorkError> {
        let recordings = self.fitted();
        let mut result = identify_watched(&self.model, &recordings, method, watch)?;
        result.add_history(&jiff::Timestamp::now().to_string(), &recordings);
        Ok(IdentifiedResult { given: self.model.clone(), result })
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
