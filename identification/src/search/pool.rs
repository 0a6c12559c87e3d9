//! The pool of all trials so far.

use std::collections::BTreeSet;
use std::time::Instant;

use excavator_model::Model;
use excavator_model::effects::Text;
use excavator_model::recording::Recording;

use super::input_floor::input_floor;
use super::transient::evaluate_in_windows_of;
use super::trial::key_of;
use super::{Addition, AdditionError, Effort, Trial, scoring};
use crate::decision::{Policy, Scores, Verdict, decide, log_error_ratio};
use crate::fit::{Fit, FitError, FitSettings, fit};

/// An effect that was not promising enough for a full fit.
#[derive(Debug, Clone)]
pub struct Unpromising {
    /// `effect@place`.
    pub name: String,
    /// Name of the effect.
    pub effect: Text,
    /// Name of its place.
    pub place: String,
    /// Decrease of the loss on the identification recordings that its first step predicted, or that its first steps
    /// reached.
    pub promised_improvement: f64,
}

/// What a search does with a hypothesis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Move {
    /// Fit it until it converges.
    Settle,
    /// Remove each of its effects in turn.
    Prune,
    /// Add every other effect to it.
    Extend,
    /// Add every other effect that the flow balances by themselves do not show.
    ExtendForces,
    /// Add every other effect to it without one of its effects, for each of these in turn.
    Swap,
    /// Replace its effects by rivals.
    Exchange,
    /// Replace its effects by structural effects.
    Structural,
}

/// Trials, their scores (one each, in the same order), and the moves already made with them.
pub struct Pool<'a> {
    /// The given model before any fit.
    data_sheet: Model,
    identification: &'a [&'a Recording],
    validation: &'a [&'a Recording],
    /// The given model first.
    pub trials: Vec<Trial>,
    /// One hypothesis for each trial.
    pub scores: Scores,
    /// Effects that were dropped in the screening of additions to the given model, the most promising first.
    pub unpromising: Vec<Unpromising>,
    /// Additions to the given model that could not be fitted, with the reason.
    pub failed: Vec<(String, AdditionError)>,
    done: BTreeSet<(Move, Vec<String>)>,
}

impl<'a> Pool<'a> {
    /// Creates a pool with the fitted given model. `data_sheet` is that model before the fit.
    pub(super) fn new(
        data_sheet: &Model,
        given: Trial,
        identification: &'a [&'a Recording],
        validation: &'a [&'a Recording],
    ) -> Self {
        let scores = scoring::begin(&given, data_sheet, identification, validation);
        Pool {
            data_sheet: data_sheet.clone(),
            identification,
            validation,
            trials: vec![given],
            scores,
            unpromising: Vec::new(),
            failed: Vec::new(),
            done: BTreeSet::new(),
        }
    }

    /// The pool with another fit of the given model. Hypotheses of several effects stay: they did not start from it.
    ///
    /// # Errors
    /// [`FitError`] if the fit cannot be evaluated on the validation recordings.
    pub(super) fn restarted(self, settings: &FitSettings, given: Fit) -> Result<Self, FitError> {
        let given = Trial::given(given, self.validation, settings)?;
        let mut pool = Pool::new(&self.data_sheet, given, self.identification, self.validation);
        pool.done = self.done.into_iter().filter(|(_, key)| key.len() > 1).collect();
        self.trials.into_iter().filter(|trial| trial.additions.len() > 1).for_each(|trial| pool.put(trial));
        Ok(pool)
    }

    /// Computes the error floor of the input readings, if the given model leaves more than noise.
    pub(super) fn look_at_inputs(&mut self, effort: &Effort, policy: &Policy) {
        let (given, settings) = (&self.trials[0], &effort.fit);
        if log_error_ratio(&self.scores.validation, &self.scores.given().validation) <= policy.noise_margin {
            return;
        }
        let floor = input_floor(&given.validation, self.validation, settings).unwrap_or_default();
        self.scores.identification.input_floor.clone_from(&floor);
        self.scores.validation.input_floor = floor;
    }

    /// The given model before any fit.
    pub(crate) fn data_sheet(&self) -> &Model {
        &self.data_sheet
    }

    /// The given model, fitted.
    pub fn given(&self) -> &Trial {
        &self.trials[0]
    }

    /// Recordings that are fitted.
    pub(crate) fn identification(&self) -> &'a [&'a Recording] {
        self.identification
    }

    /// Recordings that evidence is taken from.
    pub(crate) fn validation(&self) -> &'a [&'a Recording] {
        self.validation
    }

    /// A trial with these additions, fitted from `start` and evaluated with the windows of `known`. Returns `None` if one of both
    /// fails.
    pub(super) fn fitted(
        &self,
        additions: Vec<Addition>,
        start: &Model,
        known: &Model,
        settings: &FitSettings,
    ) -> Option<Trial> {
        let begin = Instant::now();
        let fit = fit(start, self.identification, settings).ok()?;
        let validation = evaluate_in_windows_of(&fit.model, known, self.validation, settings).ok()?;
        Some(Trial { additions, fit, validation, seconds: begin.elapsed().as_secs_f64(), error: None })
    }

    /// Adds a trial, or replaces the one with the same additions if the new fit is better.
    pub(super) fn put(&mut self, trial: Trial) {
        let key = trial.key();
        match self.find(&key) {
            Some(known) if self.trials[known].fit.loss() <= trial.fit.loss() => {}
            Some(known) => {
                self.scores.hypotheses[known] = self.score(&trial);
                self.trials[known] = trial;
            }
            None => {
                self.scores.hypotheses.push(self.score(&trial));
                self.trials.push(trial);
            }
        }
    }

    fn score(&self, trial: &Trial) -> crate::decision::Hypothesis {
        scoring::score(trial, &self.given().fit.model, &self.data_sheet, self.identification)
    }

    /// Number of the trial with these names, sorted.
    pub(super) fn find(&self, key: &[String]) -> Option<usize> {
        self.trials.iter().position(|trial| trial.key() == key)
    }

    /// Number of the trial with these additions, in any order.
    pub(super) fn find_additions(&self, additions: &[Addition]) -> Option<usize> {
        self.find(&key_of(additions, &self.given().fit.model))
    }

    /// Marks this move of the trial as done.
    pub(super) fn mark_done(&mut self, what: Move, number: usize) {
        self.done.insert((what, self.trials[number].key()));
    }

    /// Whether this move of the trial was done.
    pub(super) fn was_done(&self, what: Move, number: usize) -> bool {
        self.done.contains(&(what, self.trials[number].key()))
    }

    /// The verdict on what was tried so far.
    pub(crate) fn verdict(&self, policy: &Policy) -> Verdict {
        decide(&self.scores, policy)
    }
}
