//! Diagnoses a model from recordings and returns a verdict.

use excavator_model::Model;
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::remainder::remainders;
use super::residual_map::{follows, residual_map};
use super::residual_points::points;
use super::{Remainder, Share, Unexplained};
use crate::decision::{Kind, Policy, Scores, Verdict, decide};
use crate::fit::FitError;
use crate::regression::RegressionError;
use crate::search::{Effort, Pool, Trial, Unpromising, search};
use crate::validation::mean_error;

/// Result of a diagnosis.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The verdict on the scores.
    pub verdict: Verdict,
    /// The scores behind the verdict.
    pub scores: Scores,
    /// The fits behind the scores, one for each hypothesis.
    pub trials: Vec<Trial>,
    /// Additions to the given model whose fit was not completed, with the improvement that its first steps brought or promised,
    /// best first.
    pub unpromising: Vec<Unpromising>,
    /// Additions that could not be fitted, with the reason.
    pub failed: Vec<(String, String)>,
    /// Where the residual of the given model is, on the validation recordings.
    pub map: Vec<Share>,
    /// What is left in each balance on the validation recordings, the largest first.
    pub remainders: Vec<Remainder>,
    /// The remaining residual, if no effect explains it.
    pub unexplained: Option<Unexplained>,
}

/// Why a diagnosis fails.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DiagnosisError {
    /// The residual cannot be formed.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// The given model cannot be fitted.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// No validation recording.
    #[error("no validation recording; evidence must come from data that was not fitted")]
    NoValidation,
}

/// Settings of a diagnosis.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DiagnosisSettings {
    /// How much is tried.
    pub effort: Effort,
    /// Rules of the verdict.
    pub policy: Policy,
}

/// Finds the effect that `model` is missing. Parameters are fitted to `identification`; evidence comes from `validation`.
/// `progress` receives the current step as text and the fraction done.
///
/// ```no_run
/// use excavator_identification::prelude::*;
/// use excavator_model::prelude::*;
///
/// # fn verdict(model: &Model, fitted: &Recording, judging: &Recording) -> Result<(), Box<dyn std::error::Error>> {
/// let progress = |what: &str, share: f64| eprintln!("{:3.0} % {what}", 100.0 * share);
/// let found = diagnose(model, &[fitted], &[judging], &DiagnosisSettings::default(), &progress)?;
/// if found.verdict.kind == Kind::MissingEffect {
///     for candidate in found.selected() {
///         println!("{} at {}", candidate.name(), candidate.place());
///     }
/// }
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// [`DiagnosisError`].
pub fn diagnose(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Diagnosis, DiagnosisError> {
    if validation.is_empty() {
        return Err(DiagnosisError::NoValidation);
    }
    let DiagnosisSettings { effort, policy } = settings;
    let pool = search(model, identification, validation, effort, policy, progress)?;
    let verdict = decide(&pool.scores, policy);
    progress("where the model fails", 1.0);
    Ok(diagnosis_of(pool, verdict, settings, validation)?)
}

/// Combines a search and its verdict into a diagnosis. The models that a refinement would write lose the nuisance effects that do
/// not show, so that both have the same parameters and errors.
///
/// # Errors
/// [`RegressionError`] if the recordings lack inputs.
pub(crate) fn diagnosis_of(
    pool: Pool<'_>,
    verdict: Verdict,
    settings: &DiagnosisSettings,
    validation: &[&Recording],
) -> Result<Diagnosis, RegressionError> {
    let (policy, identification, data_sheet) = (&settings.policy, pool.identification(), pool.data_sheet().clone());
    let failed = pool.failed.into_iter().map(|(name, error)| (name, error.to_string())).collect();
    let (trials, scores, unpromising) = (pool.trials, pool.scores, pool.unpromising);
    let (map, remainders, unexplained) = (Vec::new(), Vec::new(), None);
    let mut diagnosis = Diagnosis { verdict, scores, trials, unpromising, failed, map, remainders, unexplained };
    let simple: Vec<(usize, Trial)> = diagnosis
        .on_paths()
        .into_par_iter()
        .map(|number| {
            let simple =
                diagnosis.trials[number].simplified(&data_sheet, identification, validation, &settings.effort.fit);
            // A model that cannot be fitted without them keeps them.
            Some((number, simple.ok()?))
        })
        .flatten()
        .collect();
    simple.into_iter().for_each(|(number, trial)| diagnosis.trials[number] = trial);
    let simulated: Vec<(usize, Option<f64>)> = diagnosis
        .shown()
        .into_par_iter()
        .map(|number| (number, mean_error(&diagnosis.trials[number].fit.model, validation).ok()))
        .collect();
    simulated.into_iter().for_each(|(number, error)| diagnosis.trials[number].error = error);
    diagnosis.locate(policy, validation)?;
    Ok(diagnosis)
}

impl Diagnosis {
    /// Finds where the given model fails, and what the supported one leaves.
    fn locate(&mut self, policy: &Policy, validation: &[&Recording]) -> Result<(), RegressionError> {
        let number = self.verdict.supported();
        let (given, supported) = (&self.trials[0].fit.model, &self.trials[number].fit.model);
        let before = points(given, validation)?;
        let of_other = if number == 0 { None } else { Some(points(supported, validation)?) };
        let after = of_other.as_ref().unwrap_or(&before);
        let explains = self.verdict.standings[number].log_error_ratio <= policy.noise_margin;
        let map = residual_map(given, &before);
        let remainders = remainders(given, &before, after, explains);
        let unexplained = match self.verdict.kind {
            Kind::Unexplained => follows(supported, after),
            Kind::Adequate | Kind::MissingEffect => None,
        };
        (self.map, self.remainders, self.unexplained) = (map, remainders, unexplained);
        Ok(())
    }
}
