//! A question about a machine.

use excavator_identification::checks::{CheckError, repeated, shared_readings};
use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_model::Model;
use excavator_model::recording::Recording;

/// A model, the recordings that its parameters are fitted to, and the recordings that judge it. Its methods answer the questions
/// of the verbs: [`Study::compare`], [`Study::identify`], [`Study::characterise`], [`Study::energy`], [`Study::diagnose`],
/// [`Study::propose`], [`Study::refine`]. Recordings must have been prepared ([`crate::recordings`]).
#[derive(Debug, Clone)]
pub struct Study {
    /// The model as given.
    pub model: Model,
    /// Recordings that parameters are fitted to.
    pub identification: Vec<Recording>,
    /// Recordings that evidence is taken from; never fitted.
    pub validation: Vec<Recording>,
    /// How much a diagnosis tries, and the rules of its verdict.
    pub settings: DiagnosisSettings,
    /// Messages that the recordings rest on and that were lost, one line each.
    pub lost_messages: Vec<String>,
}

impl Study {
    /// A study of `model` with the usual settings.
    #[must_use]
    pub fn new(model: Model, identification: Vec<Recording>, validation: Vec<Recording>) -> Self {
        let settings = DiagnosisSettings::default();
        Study { model, identification, validation, settings, lost_messages: Vec::new() }
    }

    /// A study of one recording, which is compared with the model and not fitted.
    #[must_use]
    pub fn of_recording(model: Model, recording: Recording) -> Self {
        Study::new(model, Vec::new(), vec![recording])
    }

    /// A study of recordings that are fitted only.
    #[must_use]
    pub fn of_fitted(model: Model, recordings: Vec<Recording>) -> Self {
        Study::new(model, recordings, Vec::new())
    }

    /// What the recordings for the fit and those for validation have in common, one line each. `accept` has the names of checks
    /// that are overruled.
    ///
    /// # Errors
    /// [`CheckError::SharedReadings`] if a recording for validation is mostly fitted, [`CheckError::GivenTwice`] if a recording is
    /// given twice in one role.
    pub fn shared_readings(&self, accept: &[String]) -> Result<Vec<String>, CheckError> {
        let mut remarks = Vec::new();
        for shared in shared_readings(&self.fitted(), &self.judging()) {
            let (is_most, error) = (shared.is_most(), CheckError::from(shared));
            if is_most && is_refused(&error, accept) {
                return Err(error);
            }
            remarks.push(error.to_string());
        }
        for role in [self.fitted(), self.judging()] {
            remarks.extend(given_twice(&role, accept)?);
        }
        Ok(remarks)
    }

    pub(crate) fn fitted(&self) -> Vec<&Recording> {
        self.identification.iter().collect()
    }

    pub(crate) fn judging(&self) -> Vec<&Recording> {
        self.validation.iter().collect()
    }
}

/// Whether nobody overrules the refusal.
fn is_refused(error: &CheckError, accept: &[String]) -> bool {
    error.name().is_some_and(|name| accept.iter().all(|accepted| accepted != name))
}

/// A remark if a recording of one role repeats another and that is accepted.
///
/// # Errors
/// [`CheckError::GivenTwice`] if it is not accepted.
pub(crate) fn given_twice(recordings: &[&Recording], accept: &[String]) -> Result<Option<String>, CheckError> {
    let found = repeated(recordings).map(CheckError::from);
    match found {
        Some(error) if is_refused(&error, accept) => Err(error),
        found => Ok(found.map(|error| error.to_string())),
    }
}
