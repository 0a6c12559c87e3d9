//! From recordings to a verdict.

use std::sync::atomic::{AtomicUsize, Ordering};

use excavator_model::Model;
use excavator_model::effects::{Effect, Site};
use excavator_model::recording::Recording;
use rayon::prelude::*;

use super::candidate::{CandidateError, fit_addition};
use super::{Candidate, DiagnosisSettings, Share, Unexplained, additions, compare_losses, residual_map, unexplained};
use crate::fit::{Fit, FitError, FitSettings, evaluate, fit};
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
        if !chain.is_empty() && is_adequate(base_validation, validation, settings) {
            break;
        }
        let start = 0.15 + 0.8 * chain.len() as f64 / settings.most_effects as f64;
        let span = 0.8 / settings.most_effects as f64;
        let wanted = additions(&base.model);
        let (tried, failed) =
            try_all(base, base_validation, &wanted, identification, validation, settings, &|what, fraction| {
                progress(what, start + span * fraction);
            });
        let best = tried.iter().find(|candidate| candidate.accepted).cloned();
        if first_round.is_none() {
            first_round = Some((tried, failed));
        }
        match best {
            Some(best) => chain.push(best),
            None => break,
        }
    }
    let (tried, failed) = first_round.unwrap_or_default();
    let (candidates, rejected): (Vec<_>, Vec<_>) = tried.into_iter().partition(|candidate| candidate.accepted);

    let final_validation = chain.last().map_or(&nominal_validation, |last| &last.validation);
    let explained = is_adequate(final_validation, validation, settings)
        || nominal_validation.loss() - final_validation.loss() >= settings.explained_gain;
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
    Ok(Diagnosis { verdict, nominal, nominal_validation, candidates, rejected, failed, chain, map, unexplained })
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

/// Whether what is left is noise, or too small to act on.
fn is_adequate(fit: &Fit, recordings: &[&Recording], settings: &DiagnosisSettings) -> bool {
    fit.loss() <= settings.adequate_loss || normalised_error(fit, recordings) <= settings.adequate_error
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

/// Candidates that were fitted, best on validation first, and those that could not be.
type Round = (Vec<Candidate>, Vec<(String, CandidateError)>);

/// Fits every addition, best on validation first.
fn try_all(
    base: &Fit,
    base_validation: &Fit,
    wanted: &[(&'static dyn Effect, Site)],
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Round {
    let done = AtomicUsize::new(0);
    let results: Vec<(String, Result<Candidate, CandidateError>)> = wanted
        .par_iter()
        .map(|&(physics, site)| {
            let place = excavator_model::site_name(&base.model.machine, site).to_string();
            let name = format!("{}@{place}", physics.card().name);
            let candidate = try_one(base, base_validation, physics, site, place, identification, validation, settings);
            progress(&name, (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / wanted.len() as f64);
            (name, candidate)
        })
        .collect();
    let mut tried = Vec::new();
    let mut failed = Vec::new();
    for (name, result) in results {
        match result {
            Ok(candidate) => tried.push(candidate),
            Err(error) => failed.push((name, error)),
        }
    }
    tried.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
    mark_ties(&mut tried, settings);
    (tried, failed)
}

#[allow(clippy::too_many_arguments)]
fn try_one(
    base: &Fit,
    base_validation: &Fit,
    physics: &'static dyn Effect,
    site: Site,
    place: String,
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
) -> Result<Candidate, CandidateError> {
    // A candidate that has gained nothing after a few steps will not be named; its fit need not be finished.
    let give_up_above = base.loss() - settings.least_gain / 4.0;
    let patience = FitSettings { give_up_above, ..settings.fit };
    let fit = fit_addition(&base.model, physics, site, identification, &patience)?;
    let validation = evaluate(&fit.model, validation, &settings.fit)?;
    let evidence = compare_losses(base_validation, &validation);
    let identification_gain = compare_losses(base, &fit).gain;
    let accepted = evidence.gain >= settings.least_gain
        && evidence.significance >= settings.least_significance
        && identification_gain >= settings.least_gain / 2.0;
    Ok(Candidate {
        physics,
        site,
        place,
        fit,
        validation,
        evidence,
        identification_gain,
        accepted,
        tied_with_first: false,
    })
}

fn mark_ties(candidates: &mut [Candidate], settings: &DiagnosisSettings) {
    let Some((first, others)) = candidates.split_first_mut() else { return };
    for other in others.iter_mut().filter(|candidate| candidate.accepted) {
        let lead = compare_losses(&other.validation, &first.validation);
        other.tied_with_first = lead.gain < settings.tie_gain || lead.significance < settings.tie_significance;
        first.tied_with_first |= other.tied_with_first;
    }
}
