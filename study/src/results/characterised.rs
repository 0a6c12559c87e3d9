//! Valve and friction characteristics, without a simulation.

use excavator_identification::characterisation::{Characterisation, characterise};
use excavator_identification::results;
use excavator_model::Model;
use excavator_report::characterisation_page;

use super::Outcome;
use crate::steady_model::with_steady_values;
use crate::{Study, WorkError, json_text};

/// Result of `characterise`.
#[must_use]
pub struct Characterised {
    model: Model,
    sources: Vec<String>,
    found: Vec<Characterisation>,
}

impl Study {
    /// Determines all characteristics of valve and friction that the identification recordings together allow.
    pub fn characterise(&self) -> Characterised {
        let sources = self.identification.iter().map(|recording| recording.source.clone()).collect();
        Characterised { model: self.model.clone(), sources, found: characterise(&self.model, &self.fitted()) }
    }
}

impl Characterised {
    /// What was found, cylinder by cylinder.
    pub fn found(&self) -> &[Characterisation] {
        &self.found
    }

    /// The model with what was found: null, gains, losses of a pump, friction, weight and stops, as starts for a fit.
    ///
    /// # Errors
    /// [`WorkError::Model`] if a cylinder cannot have a null.
    pub fn steady_model(&self) -> Result<Model, WorkError> {
        Ok(with_steady_values(&self.model, &self.found)?)
    }

    /// The model as given.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Name of the machine.
    pub fn machine(&self) -> &str {
        &self.model.machine.name
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
