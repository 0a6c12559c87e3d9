//! Successive halving of the additions to one hypothesis.
//!
//! A full fit of every effect at every place would take minutes. One simulation with sensitivities to all effects shows
//! which of them cannot improve the fit, and where the others start. Three steps of a fit on the hardest stretches show
//! how much of the error these can explain. The best are fitted to convergence on all recordings. Evidence comes from
//! full fits only.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use excavator_model::site_name;
use rayon::prelude::*;

use super::addition::{Addition, AdditionError};
use super::pool::Unpromising;
use super::promises::Promised;
use super::starts::can_be_transient;
use super::track::{Track, few_steps};
use super::{Effort, Trial};
use crate::fit::{Fit, fit, fit_predicted};

/// The screening of additions to `base`.
pub(super) struct Screening<'a> {
    /// The trial that they are added to.
    pub base: &'a Trial,
    /// Recordings that are fitted.
    pub identification: &'a [&'a excavator_model::recording::Recording],
    /// Recordings that evidence is taken from.
    pub validation: &'a [&'a excavator_model::recording::Recording],
    /// Improvement that an attribution needs. A first step must predict a quarter of it.
    pub least_improvement: f64,
    /// How much is tried.
    pub effort: &'a Effort,
}

/// Results of the screening of all additions.
#[derive(Default)]
pub(super) struct Screened {
    /// Best first, after a few steps.
    pub candidates: Vec<Screen>,
    /// Additions that are not promising enough for a full fit.
    pub unpromising: Vec<Unpromising>,
    /// Additions that could not be fitted, with the reason.
    pub failed: Vec<(String, AdditionError)>,
}

/// A candidate after a few steps.
pub(super) struct Screen {
    addition: Addition,
    name: String,
    fit: Fit,
    /// Decrease of the loss on the stretches that it was screened on.
    pub improvement: f64,
}

impl Screen {
    /// Whether more steps could improve it.
    pub fn is_unfinished(&self) -> bool {
        !self.fit.converged
    }

    /// Converts the candidate into one without a full fit.
    pub fn left_behind(self) -> Unpromising {
        let place = site_name(&self.fit.model.machine, self.addition.site).to_string();
        let (name, effect) = (self.name, self.addition.physics.card().name.clone());
        Unpromising { name, effect, place, promised_improvement: self.improvement }
    }
}

enum Outcome {
    Screened(Box<Screen>),
    Unpromising(Unpromising),
    Failed(AdditionError),
}

impl Screening<'_> {
    /// Fits every addition for a few steps and returns the best first. `advance` is called with each name when it is
    /// done.
    pub fn run(&self, mut wanted: Vec<Addition>, advance: &(dyn Fn(&str, f64) + Sync)) -> Screened {
        let hard = Track::hard(self.base, self.identification, self.effort);
        // A transient effect acts in a window of a whole recording.
        let whole = Track::whole(self.base, self.identification);
        let machine = &self.base.fit.model.machine;
        let needs_all = |one: &Addition| can_be_transient(&*one.physics, machine, one.site);
        let (done, total) = (AtomicUsize::new(0), wanted.len().max(1) as f64);
        // The longest fits start first. Otherwise one core would finish them alone at the end.
        wanted.sort_by_key(|addition| !needs_all(addition));
        let of_whole = wanted.iter().take_while(|one| needs_all(one)).count();
        let track = |number: usize| hard.as_ref().filter(|_| number >= of_whole).unwrap_or(&whole);
        let settings = &self.effort.fit;
        let mut promised = whole.promised(&wanted[..of_whole], settings);
        promised.extend(track(of_whole).promised(&wanted[of_whole..], settings));
        let outcomes: Vec<(String, Outcome)> = wanted
            .into_par_iter()
            .zip(promised)
            .enumerate()
            .map(|(number, (addition, promised))| {
                let name = addition.name(&self.base.fit.model);
                let outcome = self.screened(addition, track(number), promised).unwrap_or_else(Outcome::Failed);
                advance(&name, (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / total);
                (name, outcome)
            })
            .collect();
        let mut screened = Screened::default();
        for (name, outcome) in outcomes {
            match outcome {
                Outcome::Screened(screen) => screened.candidates.push(*screen),
                Outcome::Unpromising(effect) => screened.unpromising.push(effect),
                Outcome::Failed(error) => screened.failed.push((name, error)),
            }
        }
        screened.candidates.sort_by(|a, b| b.improvement.total_cmp(&a.improvement));
        screened
    }

    /// Number of the leading candidates that always get a full fit.
    pub fn finalists(&self, candidates: &[Screen]) -> usize {
        let best = candidates.first().map_or(0.0, |screen| screen.improvement);
        let is_finalist = |(position, screen): (usize, &Screen)| {
            screen.improvement >= self.least_improvement / 4.0
                && (position < self.effort.finalists || best - screen.improvement < self.effort.finalist_margin)
        };
        candidates.iter().enumerate().filter(|&entry| is_finalist(entry)).count()
    }

    /// Fits candidates to convergence and evaluates them on the validation recordings.
    pub fn to_the_end(
        &self,
        candidates: Vec<Screen>,
        advance: &(dyn Fn(&str, f64) + Sync),
    ) -> Vec<(String, Result<Trial, AdditionError>)> {
        let (done, total) = (AtomicUsize::new(0), candidates.len().max(1) as f64);
        candidates
            .into_par_iter()
            .map(|screen| {
                let name = screen.name.clone();
                let trial = self.trial(screen);
                advance(&name, (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / total);
                (name, trial)
            })
            .collect()
    }

    /// Takes a few steps from the most promising start.
    fn screened(
        &self,
        addition: Addition,
        track: &Track<'_>,
        promised: Option<Promised>,
    ) -> Result<Outcome, AdditionError> {
        let base = &track.base.model;
        let name = addition.name(base);
        let unpromising = |promised_improvement: f64| {
            let place = site_name(&base.machine, addition.site).to_string();
            let effect = addition.physics.card().name.clone();
            Ok(Outcome::Unpromising(Unpromising { name: name.clone(), effect, place, promised_improvement }))
        };
        let least = self.least_improvement / 4.0;
        if let Some(promised) = promised.as_ref().filter(|own| own.is_straight && own.improvement < least) {
            return unpromising(promised.improvement);
        }
        let start = track.start(&addition, promised, least, self.effort)?;
        let promised_improvement = track.base.loss() - start.promise.loss_after;
        // The prediction of one step is reliable only if the start is close to the base.
        let is_trusted =
            (start.promise.loss_before - track.start_loss(&self.effort.fit)).abs() < self.effort.trusted_distance;
        if is_trusted && promised_improvement < least {
            return unpromising(promised_improvement);
        }
        let fit = fit_predicted(&start.model, start.promise, &track.recordings(), &few_steps(self.effort))?;
        let improvement = track.base.loss() - fit.loss();
        Ok(Outcome::Screened(Box::new(Screen { addition, name, fit, improvement })))
    }

    fn trial(&self, screen: Screen) -> Result<Trial, AdditionError> {
        let begin = Instant::now();
        let fit = fit(&screen.fit.model, self.identification, &self.effort.fit)?;
        self.base.extended(screen.addition, fit, self.validation, &self.effort.fit, begin)
    }
}
