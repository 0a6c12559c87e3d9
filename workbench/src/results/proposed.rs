//! Proposed laws for effects that are missing from a model and from every catalogue.

use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::proposal::{Proposals, propose};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::document::catalogue_text;
use excavator_model::recording::Recording;
use excavator_report::{proposal_page, proposal_sentence};

use super::{Outcome, Progress};
use crate::{WorkError, json_text};

/// Result of `propose`.
pub struct Proposed {
    /// The model as given.
    pub model: Model,
    /// The laws, and the measures used to judge them.
    pub found: Proposals,
}

impl Proposed {
    /// Proposes laws, best first.
    ///
    /// # Errors
    /// [`WorkError::Diagnosis`].
    pub fn of(
        model: &Model,
        identification: &[&Recording],
        validation: &[&Recording],
        progress: Progress<'_>,
    ) -> Result<Self, WorkError> {
        let found = propose(model, identification, validation, &DiagnosisSettings::default(), progress)?;
        Ok(Proposed { model: model.clone(), found })
    }
}

impl Outcome for Proposed {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&results::Proposals::of(&self.found))
    }

    fn sentence(&self) -> String {
        proposal_sentence(&self.model, &self.found)
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(proposal_page(&self.model, &self.found)))
    }

    fn file(&self) -> Result<Option<String>, WorkError> {
        let laws = self.found.proposals.iter().map(|proposal| proposal.text.clone()).collect();
        Ok(Some(catalogue_text(laws)?))
    }
}
