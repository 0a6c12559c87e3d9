//! What changed in a machine between two sets of recordings.

use excavator_identification::change::{Changes, changes};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::{change_page, change_sentence};

use super::Outcome;
use crate::{Study, WorkError, json_text};

/// Result of `changed`.
pub struct Changed {
    /// The model as given.
    pub model: Model,
    /// The parameters before and after.
    pub found: Changes,
    /// Duration of the first recording after, s.
    pub duration: f64,
}

impl Study {
    /// Fits the model to the identification recordings, taken before, and to the validation recordings, taken after, and compares
    /// its parameters.
    ///
    /// # Errors
    /// [`WorkError::Fit`].
    pub fn changed(self) -> Result<Changed, WorkError> {
        let found = changes(&self.model, &self.fitted(), &self.judging(), &self.settings.effort.fit)?;
        let duration = self.validation.first().map_or(0.0, Recording::duration);
        Ok(Changed { duration, found, model: self.model })
    }
}

impl Outcome for Changed {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&results::Change::of(&self.found))
    }

    fn sentence(&self) -> String {
        change_sentence(&self.model, &self.found)
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(change_page(&self.model, &self.found)))
    }

    fn model(&self) -> Option<&Model> {
        Some(&self.found.after.model)
    }
}
