//! Results of a search for laws.

use excavator_model::equations::Situation;
use excavator_model::formula::FormulaText;
use excavator_model::recording::Recording;
use excavator_model::{ModelEffect, site_name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::grammar::{PROPOSED, rounded};
use super::merits::{Merits, law_of, merits};
use super::survey::Survey;
use crate::decision::Verdict;
use crate::diagnosis::{Diagnosis, DiagnosisError, DiagnosisSettings, Unexplained, diagnosis_of, unexplained};
use crate::regression::situations_along;
use crate::search::{Pool, Trial};
use crate::validation::{Comparison, compare, mean_error_of};

/// What comes of a search for laws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ProposalVerdict {
    /// A law explains what the model is missing.
    Law,
    /// Something is missing, and no law of the grammar explains it.
    NoLaw,
    /// Nothing is missing.
    Adequate,
    /// An effect of the catalogue explains it.
    MissingEffect,
}

impl ProposalVerdict {
    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            ProposalVerdict::Law => "law",
            ProposalVerdict::NoLaw => "no_law",
            ProposalVerdict::Adequate => "adequate",
            ProposalVerdict::MissingEffect => "missing_effect",
        }
    }
}

/// A law with its assessment.
#[derive(Debug, Clone)]
pub struct Proposal {
    /// The law in the form of a catalogue. Its start values are the fitted values.
    pub text: FormulaText,
    /// Name of its place.
    pub place: String,
    /// The effect with its fitted parameters.
    pub effect: ModelEffect,
    /// Number of the trial in [`Diagnosis::trials`].
    pub trial: usize,
    /// Other effects of that trial, `effect@place`.
    pub beside: Vec<String>,
    /// Mean normalised squared error on the validation recordings.
    pub validation_error: f64,
    /// Decrease of the log error ratio on the validation recordings.
    pub evidence: f64,
    /// Whether it explains the recordings: the first proposal of a law, and those that cannot be distinguished from it.
    pub is_in_set: bool,
    /// Whether it is a table of the curve instead of a law.
    pub is_a_curve: bool,
    /// What speaks for it and against it.
    pub merits: Merits,
}

/// Proposed laws and all that was tried.
#[derive(Debug, Clone)]
pub struct Proposals {
    /// The verdict.
    pub kind: ProposalVerdict,
    /// Proposals, the best first. Empty if nothing is missing or the catalogue explains it.
    pub proposals: Vec<Proposal>,
    /// Mean normalised squared error of the refitted model on the validation recordings.
    pub error_before: f64,
    /// The refitted model on each validation recording.
    pub before: Vec<Comparison>,
    /// Everything that was tried. The laws are among the hypotheses.
    pub diagnosis: Diagnosis,
    /// Where something is missing and what it depends on, from the predictions for single terms.
    pub survey: Survey,
    /// What the given model lacks, as a curve; `None` if its catalogue explains it.
    pub lacking: Option<Unexplained>,
}

/// Largest number of proposals.
const MOST: usize = 10;

/// Collects the results.
///
/// # Errors
/// [`DiagnosisError::Regression`] if the recordings lack inputs.
pub(super) fn proposals(
    kind: ProposalVerdict,
    pool: Pool<'_>,
    verdict: Verdict,
    settings: &DiagnosisSettings,
    survey: Survey,
    identification: &[&Recording],
    validation: &[&Recording],
) -> Result<Proposals, DiagnosisError> {
    let diagnosis = diagnosis_of(pool, verdict, settings, validation)?;
    let before = comparisons(diagnosis.given(), validation);
    let error_before = mean_error_of(&before);
    let is_needed = matches!(kind, ProposalVerdict::Law | ProposalVerdict::NoLaw);
    let lacking =
        if is_needed { unexplained(&diagnosis.given().fit.model, validation, &settings.policy)? } else { None };
    let mut proposals = Vec::new();
    let numbers = if is_needed { ranked(&diagnosis, kind) } else { Vec::new() };
    let (curves, laws): (Vec<usize>, Vec<usize>) =
        numbers.into_iter().partition(|&number| is_curve(&diagnosis.trials[number]));
    for number in laws.into_iter().chain(curves) {
        let found = of_trial(&diagnosis, number, kind, identification, validation)?;
        let is_a_curve = found.iter().any(|one| one.is_a_curve);
        // A law with a coefficient that may be zero is another law of the list with an extra term.
        let is_sure = is_a_curve || found.iter().all(|one| one.is_in_set || one.merits.unsure_signs.is_empty());
        if !is_sure || !is_a_curve && proposals.len() >= MOST {
            continue;
        }
        for proposal in found {
            // A law that several hypotheses share is listed once, with the best of them.
            if !proposals.iter().any(|other: &Proposal| other.text.name == proposal.text.name) {
                proposals.push(proposal);
            }
        }
    }
    Ok(Proposals { kind, survey, proposals, error_before, before, diagnosis, lacking })
}

/// Trials with laws that improve on the given model, by the error that they leave. If a law explains the recordings, the
/// verdict's own come first: they are the simplest of those that cannot be told apart.
fn ranked(diagnosis: &Diagnosis, kind: ProposalVerdict) -> Vec<usize> {
    let standings = &diagnosis.verdict.standings;
    let has_law = |trial: &Trial| trial.additions.iter().any(|addition| addition.physics.formula().is_some_and(is_new));
    let mut numbers: Vec<usize> = (1..diagnosis.trials.len())
        .filter(|&number| has_law(&diagnosis.trials[number]) && standings[number].improvement > 0.0)
        .filter(|&number| standings[number].is_admissible || is_curve(&diagnosis.trials[number]))
        .collect();
    let set: &[usize] = if kind == ProposalVerdict::Law { &diagnosis.verdict.set } else { &[] };
    let place = |number: usize| set.iter().position(|&one| one == number).unwrap_or(set.len());
    let parameters = |number: usize| diagnosis.trials[number].added_parameters();
    numbers.sort_by(|&a, &b| {
        let error = |number: usize| standings[number].log_error_ratio;
        place(a).cmp(&place(b)).then(error(a).total_cmp(&error(b))).then(parameters(a).cmp(&parameters(b)))
    });
    numbers
}

/// Whether a formula was proposed, not given by the user.
pub(super) fn is_new(text: &FormulaText) -> bool {
    text.source == PROPOSED || text.source == CURVE
}

/// Source text of a table of a curve.
pub(super) const CURVE: &str = "curve of a residual";

fn is_curve(trial: &Trial) -> bool {
    let is_curve = |text: &FormulaText| text.source == CURVE;
    trial.additions.iter().any(|addition| addition.physics.formula().is_some_and(is_curve))
}

/// The laws of a trial, with its fitted values.
fn of_trial(
    diagnosis: &Diagnosis,
    number: usize,
    kind: ProposalVerdict,
    identification: &[&Recording],
    validation: &[&Recording],
) -> Result<Vec<Proposal>, DiagnosisError> {
    let trial = &diagnosis.trials[number];
    let validation_error = mean_error_of(&comparisons(trial, validation));
    let mut situations = Vec::new();
    for recording in identification.iter().chain(validation) {
        situations.extend(situations_along(&trial.fit.model, recording)?);
    }
    let mut found = Vec::new();
    for addition in &trial.additions {
        let Some(effect) = trial.effect(addition) else { continue };
        let Some(text) = effect.physics.formula().filter(|text| is_new(text)) else { continue };
        let Some(law) = law_of(effect) else { continue };
        let others = trial.additions.iter().filter(|other| *other != addition);
        found.push(Proposal {
            text: fitted_text(text, effect),
            place: site_name(&trial.fit.model.machine, effect.site).to_string(),
            effect: effect.clone(),
            trial: number,
            beside: others.map(|other| other.name(&trial.fit.model)).collect(),
            validation_error,
            evidence: diagnosis.verdict.standings[number].improvement,
            is_in_set: kind == ProposalVerdict::Law && diagnosis.verdict.set.contains(&number),
            is_a_curve: text.source == CURVE,
            merits: merits(&law, effect, &situations),
        });
    }
    Ok(found)
}

/// Whether no new law of a trial puts energy into the machine along the recordings.
pub(super) fn laws_dissipate(trial: &Trial, situations: &[Situation<'_, f64>]) -> bool {
    let laws = trial.additions.iter().filter_map(|addition| trial.effect(addition));
    let mut laws = laws.filter_map(|effect| Some((law_of(effect)?, effect)));
    laws.all(|(law, effect)| merits(&law, effect, situations).dissipates)
}

/// The situations of a trial's fitted model along the recordings. Recordings without the signals that it needs are
/// skipped.
pub(super) fn situations_of<'t>(trial: &'t Trial, recordings: &[&Recording]) -> Vec<Situation<'t, f64>> {
    recordings.iter().flat_map(|recording| situations_along(&trial.fit.model, recording)).flatten().collect()
}

/// A formula with the fitted values as start values.
fn fitted_text(text: &FormulaText, effect: &ModelEffect) -> FormulaText {
    let mut text = text.clone();
    for parameter in &effect.parameters {
        if let Some(own) = text.parameters.get_mut(&*parameter.card.name)
            && !own.known
        {
            own.start = vec![rounded(parameter.value)];
        }
    }
    text
}

/// Comparisons of a trial with each validation recording. Recordings that it cannot be simulated on are skipped.
fn comparisons(trial: &Trial, validation: &[&Recording]) -> Vec<Comparison> {
    let model = trial.model_on_validation();
    validation.iter().filter_map(|recording| compare(&model, recording).ok()).collect()
}
