//! Proposed laws for effects that are missing from a model and from every catalogue.

use excavator_identification::proposal::{Proposals, propose};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::document::{catalogue_text, parse_catalogue};
use excavator_model::formula::FormulaText;
use excavator_report::{proposal_page, proposal_sentence};

use super::{Outcome, Progress};
use crate::{Study, WorkError, json_text};

/// Result of `propose`.
pub struct Proposed {
    /// The model as given.
    pub model: Model,
    /// The laws, and the measures used to judge them.
    pub found: Proposals,
}

impl Study {
    /// Proposes laws for what the model and its catalogue lack, best first.
    ///
    /// # Errors
    /// [`WorkError::Diagnosis`].
    pub fn propose(&self, progress: Progress<'_>) -> Result<Proposed, WorkError> {
        let found = propose(&self.model, &self.fitted(), &self.judging(), &self.settings, progress)?;
        Ok(Proposed { model: self.model.clone(), found })
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
        let laws: Vec<FormulaText> = self.found.proposals.iter().map(|proposal| proposal.text.clone()).collect();
        if laws.is_empty() {
            return Ok(None);
        }
        let text = catalogue_text(laws)?;
        // A file that the next command refuses is not written: it is read first, beside the catalogue of the model.
        parse_catalogue("the laws", &text, &self.model.catalogue)?;
        Ok(Some(text))
    }
}
