//! Proposes laws for what a model is missing.

use std::sync::Arc;

use excavator_model::effects::AnyEffect;
use excavator_model::formula::{FormulaText, Law};
use excavator_model::recording::Recording;
use excavator_model::{Model, site_name};

use super::bounded::{bounded, reverses_an_opening};
use super::curve::table_law;
use super::grammar::{COEFFICIENT, law_text};
use super::law_candidate::Candidate;
use super::promise::MOST_TERMS;
use super::proposals::{ProposalVerdict, Proposals, is_new, laws_dissipate, proposals, situations_of};
use super::screening::screen;
use super::shortlist::Shortlist;
use super::simplest::simplest_first;
use super::survey::Survey;
use crate::decision::{Kind, Policy, Reason, Verdict};
use crate::diagnosis::{DiagnosisError, DiagnosisSettings, confirmed, unexplained};
use crate::search::{Addition, Effort, Pool, Trial, search, try_each_alone, try_laws};

/// Rounds in which laws are added to the best hypothesis so far. Recordings of one machine can hardly separate two
/// unknown laws, let alone more.
const ROUNDS: usize = 2;

/// Proposes laws for what `model` is missing, if no effect of its catalogue explains it. Parameters are fitted to
/// `identification`; evidence comes from `validation`. `progress` is called with a description of the current activity
/// and the fraction done.
///
/// # Errors
/// [`DiagnosisError`].
pub fn propose(
    model: &Model,
    identification: &[&Recording],
    validation: &[&Recording],
    settings: &DiagnosisSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Proposals, DiagnosisError> {
    if validation.is_empty() {
        return Err(DiagnosisError::NoValidation);
    }
    let DiagnosisSettings { effort, policy } = settings;
    let half = |what: &str, done: f64| progress(what, 0.5 * done);
    let mut pool = search(model, identification, validation, effort, policy, &half)?;
    let verdict = confirmed(&pool, pool.verdict(policy), settings);
    let mut survey = Survey::default();
    let kind = match verdict.kind {
        Kind::Adequate => ProposalVerdict::Adequate,
        Kind::MissingEffect => ProposalVerdict::MissingEffect,
        Kind::Unexplained => {
            let trials = Trials { identification, validation, effort, policy, progress };
            survey = trials.of_laws(&mut pool)?;
            let explained = is_explained(&pool.verdict(policy));
            if !explained {
                trials.of_the_curve(&mut pool)?;
            }
            if explained { ProposalVerdict::Law } else { ProposalVerdict::NoLaw }
        }
    };
    let is_possible = |trial: &Trial| {
        let situations = situations_of(trial, identification);
        laws_dissipate(trial, &situations) && !reverses_an_opening(trial, &situations)
    };
    let differing = verdict.reasons.into_iter().find(|reason| reason.differing().is_some());
    let mut verdict = simplest_first(pool.verdict(policy), &pool.trials, &is_possible);
    if kind == ProposalVerdict::NoLaw
        && let Some(reason) = differing
    {
        verdict.kind = Kind::Unexplained;
        verdict.reasons.insert(0, reason);
    }
    proposals(kind, pool, verdict, settings, survey, identification, validation)
}

/// Largest share of the misfit that a first law may leave if a second one is to be searched.
const LARGEST_REST: f64 = 0.5;

/// Whether the favoured hypothesis leaves little. A different construction of the machine may explain the recordings as
/// well; a law expresses that in another form.
fn is_explained(verdict: &Verdict) -> bool {
    verdict.reasons.iter().any(|reason| matches!(reason, Reason::Explained { .. }))
}

struct Trials<'a> {
    identification: &'a [&'a Recording],
    validation: &'a [&'a Recording],
    effort: &'a Effort,
    policy: &'a Policy,
    progress: &'a (dyn Fn(&str, f64) + Sync),
}

impl Trials<'_> {
    /// Adds laws from the equations to the given model, then to the best hypothesis so far, until one explains the
    /// recordings. Returns the predictions for single terms added to the given model.
    fn of_laws(&self, pool: &mut Pool<'_>) -> Result<Survey, DiagnosisError> {
        let (mut base, mut survey) = (0, Survey::default());
        for round in 0..ROUNDS {
            let share = |done: f64| 0.5 + 0.5 * (round as f64 + done) / (ROUNDS + 1) as f64;
            (self.progress)("terms on the equations", share(0.0));
            let left = MOST_TERMS.saturating_sub(terms_of(&pool.trials[base]));
            if left == 0 {
                return Ok(survey);
            }
            let given = pool.trials[base].fit.clone();
            let screening = screen(&given.model, self.identification, self.validation)?;
            let fitting = &self.effort.fit;
            let listed = Shortlist::new(&given.model, given.loss(), &screening, self.identification, fitting);
            if round == 0 {
                survey = Survey::of(&given.model, &listed.foretold);
            }
            let progress = |what: &str, done: f64| (self.progress)(what, share(done));
            let laws = additions(&listed.singles, pool);
            try_laws(pool, base, laws, self.effort, self.policy, &progress);
            if !is_explained(&pool.verdict(self.policy)) {
                let mut several = listed.several(&given.model, self.identification, fitting);
                several.retain(|law| law.terms.len() <= left);
                let laws = additions(&several, pool);
                try_laws(pool, base, laws, self.effort, self.policy, &progress);
            }
            self.bounded(pool);
            if round > 0 {
                // A law that was found beside another may explain everything by itself.
                (self.progress)("each law alone", share(0.9));
                try_each_alone(pool, self.effort, self.policy, &progress);
            }
            let verdict = pool.verdict(self.policy);
            let ratio = |number: usize| verdict.standings[number].log_error_ratio;
            let is_promising = verdict.best != 0 && ratio(verdict.best) < LARGEST_REST * ratio(0);
            if is_explained(&verdict) || !is_promising {
                return Ok(survey);
            }
            base = verdict.best;
        }
        Ok(survey)
    }

    /// Also tries, for each favoured law that would reverse an opening, the form that closes it instead.
    fn bounded(&self, pool: &mut Pool<'_>) {
        let progress = |what: &str, _: f64| (self.progress)(what, 0.9);
        for number in pool.verdict(self.policy).set {
            if let Some((base, law)) = bounded(pool, number, self.identification) {
                try_laws(pool, base, vec![law], self.effort, self.policy, &progress);
            }
        }
    }

    /// Tries the curve of the residual as a law, which lowers the error without an explanation.
    fn of_the_curve(&self, pool: &mut Pool<'_>) -> Result<(), DiagnosisError> {
        let model = &pool.given().fit.model;
        let Some(left) = unexplained(model, self.identification, self.policy)? else { return Ok(()) };
        let taken = names_taken(pool);
        let named = |text: FormulaText| FormulaText { name: free_name(&text.name, &taken), ..text };
        let Some(law) = table_law(&left).and_then(|text| Law::read(&named(text)).ok()) else { return Ok(()) };
        let physics: AnyEffect = Arc::new(law);
        let place = left.equation.split_once('.').map_or("", |(place, _)| place);
        let sites = model.free_sites(&physics).into_iter().filter(|&site| site_name(&model.machine, site) == place);
        let curve: Vec<Addition> = sites.map(|site| Addition { physics: physics.clone(), site }).collect();
        let progress = |what: &str, _: f64| (self.progress)(what, 0.9);
        try_laws(pool, 0, curve, self.effort, self.policy, &progress);
        Ok(())
    }
}

/// Terms of the laws that a hypothesis adds.
fn terms_of(trial: &Trial) -> usize {
    let laws = trial.additions.iter().filter_map(|addition| trial.effect(addition));
    let proposed = laws.filter(|effect| effect.physics.formula().is_some_and(is_new));
    proposed.flat_map(|effect| &effect.parameters).filter(|parameter| parameter.card.meaning == COEFFICIENT).count()
}

/// The laws of a shortlist as effects with unique names.
fn additions(listed: &[Candidate], pool: &Pool<'_>) -> Vec<Addition> {
    let mut names = names_taken(pool);
    let mut laws = Vec::new();
    for candidate in listed {
        let Some(text) = law_text(&candidate.terms, SUMMARY) else { continue };
        let text = FormulaText { name: free_name(&text.name, &names), ..text };
        names.push(text.name.clone());
        if let Ok(law) = Law::read(&text) {
            laws.push(Addition { physics: Arc::new(law), site: candidate.site });
        }
    }
    laws
}

/// Names of all effects of the catalogue and of all laws that were tried.
fn names_taken(pool: &Pool<'_>) -> Vec<String> {
    let of_catalogue = pool.given().fit.model.catalogue.iter().map(|effect| effect.card().name.to_string());
    let of_trials = pool.trials.iter().flat_map(|trial| &trial.additions);
    of_catalogue.chain(of_trials.map(|addition| addition.physics.card().name.to_string())).collect()
}

/// The name, with a number if it is taken.
fn free_name(name: &str, taken: &[String]) -> String {
    let stem: String = name.chars().take(LONGEST_STEM).collect();
    let numbered = (2..).map(|number| format!("{stem}_{number}"));
    std::iter::once(name.to_string()).chain(numbered).find(|name| !taken.contains(name)).unwrap_or_default()
}

/// Summary text of a proposed law.
const SUMMARY: &str = "A law that was proposed for what a model left unexplained.";

/// Largest number of letters in a name before a number is appended.
const LONGEST_STEM: usize = 55;
