//! Comparison of a model with a recording.

use excavator_identification::results;
use excavator_identification::validation::{Baselines, Comparison, Repeat, compare, compare_runs};
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::{Beside, comparison_page, comparison_sentence, others_sentence};

use super::Outcome;
use crate::{Study, WorkError, json_text};

/// Result of `compare`.
pub struct Compared {
    /// The model.
    pub model: Model,
    /// Comparison of the model with the recording.
    pub comparison: Comparison,
    /// Errors of predictions without the model.
    pub baselines: Baselines,
    /// Comparison of another model with the same recording.
    pub against: Option<Comparison>,
    /// Another run of the same commands.
    pub again: Option<Repeat>,
}

impl Study {
    /// Simulates the model with the input of the first validation recording and compares every output. Optionally adds another
    /// model, or another run of the same commands.
    ///
    /// # Errors
    /// [`WorkError::Run`], [`WorkError::NoRecording`].
    pub fn compare(&self, against: Option<&Model>, again: Option<&Recording>) -> Result<Compared, WorkError> {
        let (model, recording) = (&self.model, self.validation.first().ok_or(WorkError::NoRecording)?);
        let comparison = compare(model, recording)?;
        let baselines = Baselines::of(model, recording, &comparison);
        let against = against.map(|model| compare(model, recording)).transpose()?;
        let again = again.map(|again| compare_runs(model, recording, again)).transpose()?;
        Ok(Compared { model: model.clone(), comparison, baselines, against, again })
    }
}

impl Compared {
    /// The additional comparisons.
    #[must_use]
    pub fn others(&self) -> Vec<Beside<'_>> {
        self.against.iter().map(Beside::Model).chain(self.again.iter().map(Beside::Run)).collect()
    }
}

impl Outcome for Compared {
    fn json(&self) -> Result<String, WorkError> {
        let (against, again) = (self.against.as_ref(), self.again.as_ref());
        let result = results::Comparison::of(&self.comparison, &self.baselines, against, again);
        json_text(&result)
    }

    fn sentence(&self) -> String {
        let others = self.others();
        let others = others.iter().map(|other| others_sentence(&self.comparison, *other));
        std::iter::once(comparison_sentence(&self.comparison, &self.baselines))
            .chain(others)
            .collect::<Vec<_>>()
            .join(" ")
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        let (one, its_baselines) = (std::slice::from_ref(&self.comparison), std::slice::from_ref(&self.baselines));
        Ok(Some(comparison_page(&self.model, one, its_baselines, &self.others())))
    }

    fn recordings(&self) -> Vec<(&'static str, &Recording)> {
        let own = [("measured", &self.comparison.measured), ("simulated", &self.comparison.simulated)];
        let against = self.against.iter().map(|other| ("against", &other.simulated));
        own.into_iter()
            .chain(against)
            .chain(self.again.iter().map(|run| ("repeat", &run.comparison.simulated)))
            .collect()
    }
}
