//! A hypothesis with its fits.

use std::time::Instant;

use excavator_model::recording::Recording;
use excavator_model::{Model, ModelEffect};

use super::transient::{evaluate_in_windows_of, evaluate_on_others, is_transient};
use super::{Addition, AdditionError};
use crate::fit::{Fit, FitError, FitSettings, evaluate, simplified};

/// A model that was tried: the given one with some additions, fitted to the identification recordings and evaluated on the
/// validation recordings.
#[derive(Debug, Clone)]
pub struct Trial {
    /// Effects that the given model lacks, in the order in which they were selected.
    pub additions: Vec<Addition>,
    /// Fitted to the identification recordings.
    pub fit: Fit,
    /// The same model on the validation recordings; transient effects have their own windows there.
    pub validation: Fit,
    /// Wall-clock time of the fit, s.
    pub seconds: f64,
    /// Mean NMSE of the fitted model on the validation recordings, simulated from their starts, as in a comparison of that model.
    /// `None` if it was not asked for, or if the simulation failed.
    pub error: Option<f64>,
}

impl Trial {
    /// A fit of the given model as the first trial.
    ///
    /// # Errors
    /// [`FitError`] if it cannot be evaluated on the validation recordings.
    pub(super) fn given(fit: Fit, validation: &[&Recording], settings: &FitSettings) -> Result<Trial, FitError> {
        let begin = Instant::now();
        let evaluated = evaluate(&fit.model, validation, settings)?;
        let seconds = begin.elapsed().as_secs_f64();
        Ok(Trial { additions: Vec::new(), fit, validation: evaluated, seconds, error: None })
    }

    /// This trial with one more addition, whose fit `fit` began at time `begin`, evaluated on the validation
    /// recordings.
    ///
    /// # Errors
    /// [`AdditionError`] if it cannot be evaluated.
    pub(super) fn extended(
        &self,
        addition: Addition,
        fit: Fit,
        validation: &[&Recording],
        settings: &FitSettings,
        begin: Instant,
    ) -> Result<Trial, AdditionError> {
        let validation = evaluate_on_others(&fit.model, &self.validation.model, validation, settings)?;
        let mut additions = self.additions.clone();
        additions.push(addition);
        Ok(Trial { additions, fit, validation, seconds: begin.elapsed().as_secs_f64(), error: None })
    }

    /// This trial without the nuisance effects that `data_sheet` lacks and that do not show, fitted again.
    ///
    /// # Errors
    /// [`FitError`].
    pub(crate) fn simplified(
        &self,
        data_sheet: &Model,
        identification: &[&Recording],
        validation: &[&Recording],
        settings: &FitSettings,
    ) -> Result<Trial, FitError> {
        let fit = simplified(data_sheet, &self.fit, identification, settings)?;
        if fit.model.effects.len() == self.fit.model.effects.len() {
            return Ok(self.clone());
        }
        let validation = evaluate_in_windows_of(&fit.model, &self.validation.model, validation, settings)?;
        Ok(Trial { fit, validation, ..self.clone() })
    }

    /// Names of the additions, sorted: the same for every order of selection.
    pub fn key(&self) -> Vec<String> {
        key_of(&self.additions, &self.fit.model)
    }

    /// Whether `addition` is one of its own.
    pub fn adds(&self, addition: &Addition) -> bool {
        self.additions.contains(addition)
    }

    /// The effect of the fitted model for `addition`.
    pub fn effect(&self, addition: &Addition) -> Option<&ModelEffect> {
        self.fit.model.effect(&addition.physics.card().name, addition.site)
    }

    /// Number of free parameters of its additions.
    pub fn added_parameters(&self) -> usize {
        let effects = self.additions.iter().filter_map(|addition| self.effect(addition));
        effects.flat_map(|effect| &effect.parameters).filter(|parameter| !parameter.known).count()
    }

    /// The fitted model without one of its additions, not refitted.
    pub fn model_without(&self, addition: &Addition) -> Model {
        let mut model = self.fit.model.clone();
        model.effects.retain(|effect| !effect.is(&addition.physics.card().name, addition.site));
        model
    }

    /// The fitted model, its transient effects in the windows of the validation recordings.
    pub fn model_on_validation(&self) -> Model {
        let mut model = self.fit.model.clone();
        if model.effects.iter().any(is_transient) {
            model.set_parameter_values(&self.validation.model.parameter_values());
        }
        model
    }
}

/// Names of some additions to `model`, sorted.
pub(super) fn key_of(additions: &[Addition], model: &Model) -> Vec<String> {
    let mut names: Vec<String> = additions.iter().map(|addition| addition.name(model)).collect();
    names.sort();
    names
}
