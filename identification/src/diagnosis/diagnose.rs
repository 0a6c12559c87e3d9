//! From recordings to a verdict.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::adequacy::adequacy_as_given;
use super::candidate::CandidateError;
use super::chain::Chains;
use super::construction::BuiltOtherwise;
use super::race::Round;
use super::starts::within_bounds;
use super::{
    Adequacy, Candidate, DiagnosisSettings, Share, Unexplained, Unpromising, compare_losses, residual_map, unexplained,
};
use crate::fit::{Fit, FitError, evaluate, fit};
use crate::fitted_along::refitted_with_effects_along;
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
    /// Candidates that were fitted to the end and have none, with what they gained, best first.
    pub rejected: Vec<Candidate>,
    /// Effects not worth a fit to the end, with what its beginning gained or promised, best first.
    pub unpromising: Vec<Unpromising>,
    /// Candidates that could not be fitted, with the reason.
    pub failed: Vec<(String, CandidateError)>,
    /// Effects added one after the other, the first included, until nothing more was gained.
    pub chain: Vec<Candidate>,
    /// Where the residual of the nominal model is, on the validation recordings.
    pub map: Vec<Share>,
    /// What is left when nothing explains it.
    pub unexplained: Option<Unexplained>,
    /// What explains the recordings where no candidate does, if the machine is built so: nothing that a diagnosis names.
    pub construction: Option<Candidate>,
    /// Why the given model is adequate, where it is.
    pub adequacy: Option<Adequacy>,
    /// Whether the readings of the inputs leave as much open as the given model is off, and that is too much to call the
    /// model adequate: the recordings are too coarse to tell.
    pub too_coarse: bool,
}

impl Diagnosis {
    /// Number of effects that were tried; none where the given model leaves nothing but noise.
    pub fn tried(&self) -> usize {
        self.candidates.len() + self.rejected.len() + self.unpromising.len() + self.failed.len()
    }
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
    let mut nominal = fit_nominal(model, identification, settings)?;
    let mut attempts = 0;
    let (nominal_validation, adequacy, too_coarse, first_round) = loop {
        let nominal_validation = evaluate(&nominal.model, validation, &settings.fit)?;
        let (adequacy, too_coarse) = adequacy_as_given(&nominal_validation, validation, settings);
        let chains = Chains {
            nominal: &nominal,
            nominal_validation: &nominal_validation,
            nominal_is_adequate: adequacy.is_some(),
            identification,
            validation,
            settings,
        };
        let is_clean = adequacy.is_some() && nominal.loss().max(nominal_validation.loss()) <= NOTHING_LEFT;
        let round = if is_clean { Round::default() } else { chains.round(&[], &|_| true, progress) };
        match better_nominal(&nominal, &round, identification, settings) {
            Some(better) if attempts < MOST_NOMINALS => nominal = better,
            _ => break (nominal_validation, adequacy, too_coarse, round),
        }
        attempts += 1;
    };
    progress("where the model fails", 0.3);
    let map = residual_map(&nominal.model, validation)?;
    let chains = Chains {
        nominal: &nominal,
        nominal_validation: &nominal_validation,
        nominal_is_adequate: adequacy.is_some(),
        identification,
        validation,
        settings,
    };
    let (mut chain, first_round) = chains.best(first_round, progress)?;
    let Round { fitted, unpromising, failed } = first_round;
    let mut explained = chains.explains(&chain);
    // A part of what little is left is no reason to doubt a model.
    let is_beyond_doubt = matches!(adequacy, Some(Adequacy::Noise | Adequacy::SmallError));
    if !explained && is_beyond_doubt {
        chain.clear();
        explained = true;
    }
    let (mut candidates, mut rejected): (Vec<_>, Vec<_>) = fitted.into_iter().partition(|candidate| candidate.accepted);
    if let Some(first) = chain.first() {
        put_first(first, &mut candidates);
    }
    if explained && let Some(last) = chain.last() {
        mark_doubtful_leads(&mut candidates, &chain, settings.doubtful_lead * last.validation.loss());
        chain = chains.settle_ties(chain, &mut candidates, &mut rejected, progress)?;
    }
    let mut built = BuiltOtherwise::default();
    if explained && !chain.is_empty() {
        progress("what else could be built so", 0.96);
        built = chains.built_otherwise(&chain);
    }
    if !built.ahead.is_empty() {
        // What is behind it is no evidence of anything else.
        let behind = candidates.drain(..).map(|other| Candidate { accepted: false, tied_with_first: false, ..other });
        rejected.splice(0..0, behind);
    } else if let Some(first) = candidates.first_mut().filter(|_| !built.level.is_empty()) {
        first.tied_with_first = true;
        let level = built.level.iter().cloned();
        candidates.extend(level.map(|other| Candidate { accepted: true, tied_with_first: true, ..other }));
    }
    if !built.ahead.is_empty() || !built.level.is_empty() {
        // A name would be an even chance, and the other half of it is none of those that are named.
        // Little as a model may leave that is adequate else, it is seen, and by more than chance.
        chain.clear();
        explained = false;
    }
    let verdict = match (chain.is_empty(), explained) {
        (true, true) => Verdict::Adequate,
        (false, true) => Verdict::MissingEffect,
        (_, false) => Verdict::Unexplained,
    };
    let mut construction = None;
    let unexplained = if verdict == Verdict::Unexplained {
        progress("what is left", 0.97);
        construction = built.ahead.into_iter().chain(built.level).next().or_else(|| chains.built_as_nothing_named());
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
        construction,
        adequacy,
        too_coarse,
    })
}

/// Loss of an adequate model up to which no effect is tried: with a gain that would make it a name
/// ([`DiagnosisSettings::least_gain_when_adequate`]) it would have to leave three quarters of the sensors' noise. Right models
/// leave -0.06 at least on 112 blind machines that hide nothing, and 0.05 at most on nine tenths of them.
const NOTHING_LEFT: f64 = 0.05;

/// Times that a better nominal fit begins the diagnosis anew.
const MOST_NOMINALS: usize = 2;

/// Fall of the loss that makes another nominal fit a better one.
const BETTER: f64 = 0.1;

/// Candidates of a round that are looked at for a better nominal fit.
const LOOKED_AT: usize = 3;

/// A fit of the nominal model that a candidate has led to. Where the nominal fit ended in the wrong valley, whatever is
/// tried next gains by leaving it, an effect of size zero too: what is left of such a candidate without its effect is the
/// better nominal model, and no evidence for the effect.
fn better_nominal(
    nominal: &Fit,
    round: &Round,
    identification: &[&Recording],
    settings: &DiagnosisSettings,
) -> Option<Fit> {
    let least = nominal.loss() - BETTER;
    round
        .fitted
        .iter()
        .filter(|candidate| candidate.fit.loss() < least)
        .take(LOOKED_AT)
        .filter_map(|candidate| {
            let without = candidate.without_effect();
            // Of a real effect nothing good is left without it.
            let start = evaluate(&without, identification, &settings.fit).ok()?;
            (start.loss() < least).then_some(())?;
            fit(&without, identification, &settings.fit).ok()
        })
        .filter(|better| better.loss() < least)
        .min_by(|a, b| a.loss().total_cmp(&b.loss()))
}

/// What turned out to be needed comes before what only looked better alone.
fn put_first(first: &Candidate, candidates: &mut Vec<Candidate>) {
    match candidates.iter().position(|candidate| candidate.is_same_addition(first)) {
        Some(0) => return,
        Some(place) => candidates[..=place].rotate_right(1),
        None => candidates.insert(0, first.clone()),
    }
    // Ties were with another.
    candidates.iter_mut().for_each(|candidate| candidate.tied_with_first = false);
}

/// Ties of the first with candidates, other than the further links of its chain, that are behind it by less than `lead`.
fn mark_doubtful_leads(candidates: &mut [Candidate], chain: &[Candidate], lead: f64) {
    let Some((first, others)) = candidates.split_first_mut() else { return };
    for other in others.iter_mut().filter(|other| !chain.iter().any(|link| link.is_same_addition(other))) {
        if compare_losses(&other.validation, &first.validation).gain < lead {
            other.tied_with_first = true;
            first.tied_with_first = true;
        }
    }
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
    let quick =
        WeakFormSettings { rounds: 2, with_errors: false, hold_at_bounds: false, ..WeakFormSettings::default() };
    let regressed = weak_form(model, identification, &quick)
        .map(|regression| within_bounds(regression.model))
        .ok()
        .and_then(|start| fit(&start, identification, &settings.fit).ok());
    let fitted = match regressed {
        Some(fitted) if fitted.loss() <= settings.adequate_loss => fitted,
        // Something may be missing, the regression may say nothing, or an instrument that is far off may have led it astray:
        // from the given values too.
        regressed => match (regressed, fit(model, identification, &settings.fit)) {
            (Some(first), Ok(second)) if first.loss() <= second.loss() => first,
            (Some(first), Err(_)) => first,
            (_, second) => second?,
        },
    };
    Ok(refitted_with_effects_along(fitted, model.effects.len(), identification, &settings.fit))
}
