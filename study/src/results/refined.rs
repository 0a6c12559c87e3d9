//! A model with additional effects, fitted and compared again.

use excavator_identification::refinement::{Additions, Refinement, refine};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::{refinement_page, refinement_sentence};

use super::{Outcome, Progress};
use crate::{Study, WorkError, json_text};

/// Result of `refine`.
pub struct Refined {
    /// The steps and the final model.
    pub refinement: Refinement,
}

impl Study {
    /// Adds effects to the model and fits it again.
    ///
    /// # Errors
    /// [`WorkError::Refine`].
    pub fn refine(&self, additions: &Additions, progress: Progress<'_>) -> Result<Refined, WorkError> {
        let (fitted, judging, when) = (self.fitted(), self.judging(), jiff::Timestamp::now().to_string());
        let refinement = refine(&self.model, &fitted, &judging, additions, &self.settings, &when, progress)?;
        Ok(Refined { refinement })
    }
}

impl Refined {
    /// The result, with the name of the file that the model was written to.
    pub fn result(&self, written: Option<&str>) -> results::Refinement {
        results::Refinement::of(self.refinement.verdict(), self.refinement.compared_steps(), written)
    }
}

impl Outcome for Refined {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&self.result(None))
    }

    fn sentence(&self) -> String {
        refinement_sentence(&self.refinement)
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(refinement_page(&self.refinement)))
    }

    fn model(&self) -> Option<&Model> {
        Some(&self.refinement.model)
    }

    fn recordings(&self) -> Vec<(&'static str, &Recording)> {
        let last = self.refinement.steps.last().and_then(|step| step.comparisons.first());
        let given = self.refinement.given.first().map(|given| ("as given", &given.simulated));
        let own = last.map(|last| [("measured", &last.measured), ("simulated", &last.simulated)]);
        own.into_iter().flatten().chain(given).collect()
    }
}
