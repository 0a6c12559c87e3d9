//! Valve and friction characteristics, without a simulation.

use excavator_identification::characterisation::{Characterisation, characterise};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::characterisation_page;

use super::Outcome;
use crate::{WorkError, json_text};

/// Result of `characterise`.
#[must_use]
pub struct Characterised {
    model: Model,
    sources: Vec<String>,
    found: Vec<Characterisation>,
}

impl Characterised {
    /// Determines all characteristics that the recordings together allow.
    pub fn of(model: &Model, recordings: &[&Recording]) -> Self {
        let sources = recordings.iter().map(|recording| recording.source.clone()).collect();
        Characterised { model: model.clone(), sources, found: characterise(model, recordings) }
    }
}

impl Outcome for Characterised {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&results::Characterisation::of(&self.found))
    }

    fn sentence(&self) -> String {
        let names: Vec<&str> = self.found.iter().map(|one| one.cylinder.as_str()).collect();
        format!("Valve and friction of {} of {}.", names.join(", "), self.model.machine.name)
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(characterisation_page(&self.model, &self.sources, &self.found)))
    }
}
