//! A model with more effects, fitted and measured again.

use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::refinement::{Additions, Refinement, refine};
use excavator_identification::report::{refinement_page, refinement_sentence};
use excavator_identification::search::Addition;
use excavator_model::Model;
use excavator_model::recording::Recording;
use serde_json::Value;

use super::{Outcome, Progress};
use crate::WorkError;
use crate::json::refinement_json;

/// Result of `refine`.
pub struct Refined {
    refinement: Refinement,
}

impl Refined {
    /// Adds effects to `model` and fits it again.
    ///
    /// # Errors
    /// [`WorkError::Refine`].
    pub fn of(
        model: &Model,
        identification: &[&Recording],
        validation: &[&Recording],
        additions: &Additions,
        progress: Progress<'_>,
    ) -> Result<Self, WorkError> {
        let (settings, when) = (DiagnosisSettings::default(), jiff::Timestamp::now().to_string());
        let refinement = refine(model, identification, validation, additions, &settings, &when, progress)?;
        Ok(Refined { refinement })
    }
}

/// What a person named, each at every place it can act unless a place is given.
///
/// # Errors
/// [`WorkError::Model`], [`WorkError::AddedTwice`].
pub fn named_additions(model: &Model, names: &[String]) -> Result<Additions, WorkError> {
    let mut additions = Vec::new();
    for name in names {
        for (physics, site) in model.parse_addition(name)? {
            let addition = Addition { physics, site };
            if additions.contains(&addition) {
                return Err(WorkError::AddedTwice(name.clone()));
            }
            additions.push(addition);
        }
    }
    Ok(Additions::Named(additions))
}

impl Outcome for Refined {
    fn json(&self) -> Value {
        let steps = self.refinement.steps.iter().map(|step| (step.added.as_deref(), step.comparisons.as_slice()));
        refinement_json(self.refinement.verdict().name(), steps, None)
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
