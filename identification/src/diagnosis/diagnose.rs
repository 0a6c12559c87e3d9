//! From recordings to a verdict.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::candidate::CandidateError;
use super::input_floor::with_input_floor;
use super::race::{Race, Round};
use super::{Candidate, DiagnosisSettings, Share, Unexplained, Unpromising, additions, residual_map, unexplained};
use crate::fit::{Fit, FitError, evaluate, fit};
use crate::regression::{RegressionError, WeakFormSettings, weak_form};

/// What is to be thought of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// An effect of the catalogue is missing (or one of a tied set).
    MissingEffect,
    /// Nothing that matters is missing.
    Adequate,
    /// Something is missing, and it is none of those in the catalogue.
    Unexplained,
}

impl Verdict {
    /// Name in JSON.
    pub fn name(&self) -> &'static str {
        match self {
            Verdict::MissingEffect => "missing_effect",
            Verdict::Adequate => "adequate",
            Verdict::Unexplained => "unexplained",
        }
    }
}

/// Result of a diagnosis.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Verdict,
    /// The given model, refitted to the identification recordings.
    pub nominal: Fit,
    /// The same on the validation recordings.
    pub nominal_validation: Fit,
    /// Candidates with evidence, best first.
    pub candidates: Vec<Candidate>,
    /// Candidates that were tried and have none, with what they gained, best first.
    pub rejected: Vec<Candidate>,
    /// Effects not worth a fit, with what a step of one promised, best first.
    pub unpromising: Vec<Unpromising>,
    /// Candidates that could not be fitted, with the reason.
    pub failed: Vec<(String, CandidateError)>,
    /// Effects added one after the other, the first included, until nothing more was gained.
    pub chain: Vec<Candidate>,
    /// Where the residual of the nominal model is, on the validation recordings.
    pub map: Vec<Share>,
    /// What is left when nothing explains it.
    pub unexplained: Option<Unexplained>,
}

/// Why there is no verdict.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DiagnosisError {
    /// The nominal model cannot be identified.
    #[error(transparent)]
    Regression(#[from] RegressionError),
    /// The nominal model cannot be fitted.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// No validation recording.
    #[error("no validation recording; evidence must come from data that was not fitted")]
    NoValidation,
}

/// Finds out what `model` is missing. Parameters are fitted to `identification`, evidence comes from `validation`.
/// `progress` is told what is being done, in words, with the fraction done.
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
    progress("regression for start values", 0.0);
    let nominal = fit_nominal(model, identification, settings)?;
    let nominal_validation = evaluate(&nominal.model, validation, &settings.fit)?;
    progress("where the model fails", 0.1);
    let map = residual_map(&nominal.model, validation)?;

    let mut chain: Vec<Candidate> = Vec::new();
    let mut first_round: Option<Round> = None;
    while chain.len() < settings.most_effects {
        let (base, base_validation) =
            chain.last().map_or((&nominal, &nominal_validation), |last| (&last.fit, &last.validation));
        let start = 0.15 + 0.8 * chain.len() as f64 / settings.most_effects as f64;
        let span = 0.8 / settings.most_effects as f64;
        let wanted = additions(&base.model);
        let adequate = is_adequate(base_validation, validation, settings);
        if adequate && !chain.is_empty() {
            break;
        }
        let least_gain = if adequate { settings.least_gain_when_adequate } else { settings.least_gain };
        let race = Race { base, base_validation, identification, validation, least_gain, settings };
        let round = race.run(&wanted, &|what, fraction| progress(what, start + span * fraction))?;
        let best = round.fitted.iter().find(|candidate| candidate.accepted).cloned();
        if first_round.is_none() {
            first_round = Some(round);
        }
        match best {
            Some(best) => chain.push(best),
            None => break,
        }
    }
    let Round { fitted, unpromising, failed } = first_round.unwrap_or_default();
    let (candidates, rejected): (Vec<_>, Vec<_>) = fitted.into_iter().partition(|candidate| candidate.accepted);

    let final_validation = chain.last().map_or(&nominal_validation, |last| &last.validation);
    let explained = is_adequate(final_validation, validation, settings)
        || final_validation.loss() <= (1.0 - settings.explained_share) * nominal_validation.loss();
    let verdict = match (chain.is_empty(), explained) {
        (true, true) => Verdict::Adequate,
        (false, true) => Verdict::MissingEffect,
        (_, false) => Verdict::Unexplained,
    };
    let unexplained = if verdict == Verdict::Unexplained {
        progress("what is left", 0.97);
        let model = chain.last().map_or(&nominal.model, |last| &last.fit.model);
        unexplained(model, validation)?
    } else {
        None
    };
    progress("done", 1.0);
    Ok(Diagnosis {
        verdict,
        nominal,
        nominal_validation,
        candidates,
        rejected,
        unpromising,
        failed,
        chain,
        map,
        unexplained,
    })
}

/// Fits a model's unknown parameters, starting from a regression where one is possible.
///
/// # Errors
/// [`FitError`].
pub(crate) fn fit_nominal(
    model: &Model,
    identification: &[&Recording],
    settings: &DiagnosisSettings,
) -> Result<Fit, FitError> {
    // Where the regression cannot say anything the given values are the start.
    let quick = WeakFormSettings { rounds: 2, with_errors: false, ..WeakFormSettings::default() };
    let start = weak_form(model, identification, &quick).map(|regression| regression.model);
    if let Ok(start) = start
        && let Ok(fitted) = fit(&start, identification, &settings.fit)
    {
        return Ok(fitted);
    }
    fit(model, identification, &settings.fit)
}

/// Whether what is left is noise but for a few moments, or too small to act on, or as large as inputs known at samples
/// only leave open.
fn is_adequate(fit: &Fit, recordings: &[&Recording], settings: &DiagnosisSettings) -> bool {
    fit.typical_loss() <= settings.adequate_loss
        || normalised_error(fit, recordings) <= settings.adequate_error
        || with_input_floor(fit, recordings, &settings.fit)
            .is_some_and(|raised| raised.typical_loss() <= settings.adequate_loss)
}

/// Mean over instruments of squared error over the signal's own variance; `NaN` when no signal varies.
pub fn normalised_error(fit: &Fit, recordings: &[&Recording]) -> f64 {
    let errors: Vec<f64> = fit
        .instruments
        .iter()
        .zip(&fit.errors)
        .filter_map(|(instrument, error)| {
            let signals = recordings.iter().filter_map(|recording| recording.signal(&instrument.name));
            let spread = signals.map(crate::fit::standard_deviation).fold(0.0, f64::max);
            (spread > 0.0).then(|| (error / spread).powi(2))
        })
        .collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}
