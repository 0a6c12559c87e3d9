//! The moves of the search: extend, prune, exchange, structural alternatives.

use std::time::Instant;

use rayon::prelude::*;

use super::addition::{AdditionError, additions, structural_additions};
use super::balances::is_read;
use super::pool::{Move, Pool};
use super::progress::Milestones;
use super::promises::Promised;
use super::screening::{Screen, Screened, Screening};
use super::track::Track;
use super::transient::evaluate_in_windows_of;
use super::{Addition, Effort, Trial};
use crate::decision::{Policy, log_error_ratio};
use crate::fit::{FitSettings, fit_predicted, predict};

/// Settings and callbacks for making moves.
pub(super) struct Stepwise<'a> {
    /// How much is tried.
    pub effort: &'a Effort,
    /// Used only to find the favoured hypothesis.
    pub policy: &'a Policy,
    /// Receives progress reports.
    pub milestones: &'a Milestones<'a>,
}

impl Stepwise<'_> {
    /// Makes a move of trial `number`, and adds the resulting trials to the pool.
    pub fn take(&self, what: Move, number: usize, pool: &mut Pool<'_>) {
        pool.mark_done(what, number);
        match what {
            Move::Settle => self.settle(number, pool),
            Move::Prune => self.prune(number, pool),
            Move::Extend => self.extend(number, &|_| true, pool),
            Move::ExtendForces => self.extend(number, &|one| !is_read(one), pool),
            Move::Swap => self.swap(number, pool),
            Move::Exchange => self.exchange(number, pool),
            Move::Structural => self.structural(number, pool),
        }
    }

    /// Continues a fit that reached its step limit. Otherwise any addition would continue the unconverged fit and
    /// appear to explain something.
    fn settle(&self, number: usize, pool: &mut Pool<'_>) {
        let trial = &pool.trials[number];
        let settings = FitSettings { maximum_steps: self.effort.settling_steps, ..self.effort.fit };
        let (additions, before) = (trial.additions.clone(), trial.seconds);
        let settled = pool.fitted(additions, &trial.fit.model, &trial.validation.model, &settings);
        settled.into_iter().for_each(|after| pool.put(Trial { seconds: before + after.seconds, ..after }));
    }

    fn prune(&self, number: usize, pool: &mut Pool<'_>) {
        for addition in pool.trials[number].additions.clone() {
            self.without(number, &addition, pool);
        }
    }

    /// Number of the trial that has all additions of another except one. It is fitted if it does not exist yet, or if a
    /// fit from here is predicted to be better. A fit that ended in a local minimum would otherwise make the addition
    /// look necessary.
    fn without(&self, number: usize, addition: &Addition, pool: &mut Pool<'_>) -> Option<usize> {
        let begin = Instant::now();
        let trial = &pool.trials[number];
        let rest: Vec<Addition> = trial.additions.iter().filter(|other| *other != addition).cloned().collect();
        let known = pool.find_additions(&rest);
        if known == Some(0) {
            return known;
        }
        let given_up = trial.fit.loss() + self.effort.needed_beyond_doubt;
        let settings = &FitSettings { give_up_above: given_up, ..self.effort.fit };
        let start = trial.model_without(addition);
        let promise = predict(&start, pool.identification(), settings).ok()?;
        if known.is_some_and(|known| pool.trials[known].fit.loss() <= promise.loss_after) {
            return known;
        }
        let fit = fit_predicted(&start, promise, pool.identification(), settings).ok()?;
        let validation =
            evaluate_in_windows_of(&fit.model, &trial.validation.model, pool.validation(), settings).ok()?;
        let seconds = begin.elapsed().as_secs_f64();
        pool.put(Trial { additions: rest.clone(), fit, validation, seconds, error: None });
        pool.find_additions(&rest)
    }

    fn extend(&self, number: usize, is_wanted: &dyn Fn(&Addition) -> bool, pool: &mut Pool<'_>) {
        let wanted = additions(&pool.trials[number].fit.model, pool.identification());
        let wanted = wanted.into_iter().filter(is_wanted).collect();
        self.screen(number, wanted, self.policy.least_improvement, pool);
    }

    /// Screens additions to a trial, and fits the best to convergence. An addition that cannot improve it by `least` is left out.
    pub(super) fn screen(&self, number: usize, wanted: Vec<Addition>, least: f64, pool: &mut Pool<'_>) {
        let base = pool.trials[number].clone();
        let screening = Screening {
            base: &base,
            identification: pool.identification(),
            validation: pool.validation(),
            least_improvement: least,
            effort: self.effort,
        };
        let advance =
            |from: f64, to: f64| move |name: &str, done: f64| self.milestones.tell(name, from + (to - from) * done);
        let Screened { mut candidates, unpromising, failed } = screening.run(wanted, &advance(0.0, 0.6));
        let best = candidates.first().map_or(0.0, |screen| screen.improvement);
        let others = candidates.split_off(screening.finalists(&candidates));
        let mut fitted = screening.to_the_end(candidates, &advance(0.6, 0.8));
        let mut failed: Vec<(String, AdditionError)> = failed;
        self.put_all(&mut fitted, &mut failed, pool);
        // An effect with a threshold may need a dozen steps before it explains what it can. So unfinished candidates
        // are fitted before another effect is attributed in their place, or before the error is declared unexplained.
        let (mut unfinished, finished): (Vec<Screen>, Vec<Screen>) =
            others.into_iter().partition(Screen::is_unfinished);
        let left = unfinished.split_off(self.further_finalists(number, &unfinished, best, pool));
        let mut fitted = screening.to_the_end(unfinished, &advance(0.8, 1.0));
        self.put_all(&mut fitted, &mut failed, pool);
        if number == 0 {
            pool.unpromising = unpromising;
            pool.unpromising.extend(left.into_iter().chain(finished).map(Screen::left_behind));
            pool.unpromising.sort_by(|a, b| b.promised_improvement.total_cmp(&a.promised_improvement));
            pool.failed = failed;
        }
    }

    fn put_all(
        &self,
        fitted: &mut Vec<(String, Result<Trial, AdditionError>)>,
        failed: &mut Vec<(String, AdditionError)>,
        pool: &mut Pool<'_>,
    ) {
        for (name, trial) in fitted.drain(..) {
            match trial {
                Ok(trial) => pool.put(trial),
                Err(error) => failed.push((name, error)),
            }
        }
    }

    /// Number of further candidates for a full fit. They are the first of `unfinished`, which is sorted best first, in
    /// a screening whose best candidate improved by `best`.
    fn further_finalists(&self, number: usize, unfinished: &[Screen], best: f64, pool: &Pool<'_>) -> usize {
        let (effort, verdict) = (self.effort, pool.verdict(self.policy));
        let misfit = |number: usize| {
            let hypothesis = &pool.scores.hypotheses[number];
            log_error_ratio(&pool.scores.validation, &hypothesis.validation)
        };
        let before = misfit(number);
        let is_extension = pool.scores.hypotheses[verdict.best].extends(&pool.scores.hypotheses[number]);
        let after = if is_extension { misfit(verdict.best) } else { before };
        let share = if before > 0.0 { 1.0 - after / before } else { 0.0 };
        let some = effort.further_finalists.min(unfinished.len());
        if before <= self.policy.noise_margin {
            0
        } else if share < effort.little_share {
            unfinished.len()
        } else if share < effort.most_share {
            some
        } else if after > self.policy.least_improvement {
            unfinished[..some].iter().filter(|screen| screen.improvement > effort.little_share * best).count()
        } else {
            0
        }
    }

    /// Adds every other effect to the hypothesis without one of its effects, for each of these in turn.
    fn swap(&self, number: usize, pool: &mut Pool<'_>) {
        for addition in pool.trials[number].additions.clone() {
            let Some(base) = self.without(number, &addition, pool).filter(|base| *base != 0) else { continue };
            if !pool.was_done(Move::Extend, base) {
                self.take(Move::Extend, base, pool);
            }
        }
    }

    /// Replaces each effect by rivals: single effects that improved nearly as much. They were compared with it while
    /// the other missing effects still distorted the comparison.
    fn exchange(&self, number: usize, pool: &mut Pool<'_>) {
        let verdict = pool.verdict(self.policy);
        let trial = pool.trials[number].clone();
        if trial.additions.len() == 1 {
            // Its rivals were additions to the same model.
            return;
        }
        // Improvement of every effect that was fitted alone. The list is not updated here.
        let alone: Vec<(Addition, f64)> = pool
            .trials
            .iter()
            .zip(&verdict.standings)
            .filter_map(|(one, standing)| match &one.additions[..] {
                [addition] => Some((addition.clone(), standing.improvement)),
                _ => None,
            })
            .collect();
        for addition in &trial.additions {
            let own = alone.iter().find(|(single, _)| single == addition).map_or(0.0, |(_, improvement)| *improvement);
            let least = (self.effort.rival_share * own).max(self.policy.least_improvement);
            let is_rival = |(rival, improvement): &&(Addition, f64)| {
                !trial.adds(rival) && rival.physics.card().family.is_candidate() && *improvement >= least
            };
            let mut rivals: Vec<(Addition, f64)> = alone.iter().filter(is_rival).cloned().collect();
            rivals.sort_by(|a, b| b.1.total_cmp(&a.1));
            rivals.truncate(self.effort.most_rivals);
            if rivals.is_empty() {
                continue;
            }
            let base = self.trial_without(number, addition, pool);
            let Some(base) = base else { continue };
            let rivals = rivals.into_iter().map(|(rival, _)| rival).collect();
            self.put_added(&base, rivals, f64::INFINITY, None, pool);
        }
    }

    fn trial_without(&self, number: usize, addition: &Addition, pool: &mut Pool<'_>) -> Option<Trial> {
        self.without(number, addition, pool).map(|without| pool.trials[without].clone())
    }

    /// Adds trials with one more addition each, fully fitted, to the pool. An addition is skipped if the predicted loss
    /// of its first step is above `worst`. Progress is reported as `what`, or as the name of each addition.
    fn put_added(&self, base: &Trial, wanted: Vec<Addition>, worst: f64, what: Option<&str>, pool: &mut Pool<'_>) {
        let (identification, validation, effort) = (pool.identification(), pool.validation(), self.effort);
        let track = Track::whole(base, identification);
        let promised = track.promised(&wanted, &effort.fit);
        let least = self.policy.least_improvement / 4.0;
        let added = |(addition, promised): (Addition, Option<Promised>)| {
            let begin = Instant::now();
            self.milestones.tell(what.unwrap_or(&addition.name(&base.fit.model)), 0.5);
            let is_worse = |own: &Promised| own.is_straight && base.fit.loss() - own.improvement > worst;
            if promised.as_ref().is_some_and(is_worse) {
                return None;
            }
            let start = track.start(&addition, promised, least, effort).ok()?;
            if start.promise.loss_after > worst {
                return None;
            }
            let fit = fit_predicted(&start.model, start.promise, identification, &effort.fit).ok()?;
            base.extended(addition, fit, validation, &effort.fit, begin).ok()
        };
        let trials: Vec<Trial> = wanted.into_par_iter().zip(promised).filter_map(added).collect();
        trials.into_iter().for_each(|trial| pool.put(trial));
    }

    /// Replaces each effect by structural effects at its site. For the given model they are added at every site.
    fn structural(&self, number: usize, pool: &mut Pool<'_>) {
        let trial = pool.trials[number].clone();
        if trial.additions.is_empty() {
            let worst = trial.fit.loss();
            self.structural_beside(&trial, None, worst, pool);
        }
        for addition in &trial.additions {
            let Some(base) = self.trial_without(number, addition, pool) else { continue };
            let explained = base.fit.loss() - trial.fit.loss();
            let worst = trial.fit.loss() + self.effort.structural_distance.max(0.5 * explained);
            self.structural_beside(&base, Some(addition), worst, pool);
        }
    }

    fn structural_beside(&self, base: &Trial, in_place_of: Option<&Addition>, worst: f64, pool: &mut Pool<'_>) {
        let mut wanted = structural_additions(&base.fit.model);
        wanted.retain(|addition| in_place_of.is_none_or(|replaced| replaced.site == addition.site));
        self.put_added(base, wanted, worst, Some("how the machine is built"), pool);
    }

    /// Fits the missing trials on the path from the given model to the favoured hypothesis, one effect after the other. The effect
    /// that is missed least beside all others goes first.
    pub fn complete_path(&self, pool: &mut Pool<'_>) {
        let mut number = pool.verdict(self.policy).best;
        let additions = pool.trials[number].additions.clone();
        self.milestones.tell("one effect after the other", 0.5);
        let mut missed: Vec<(f64, Addition)> = Vec::new();
        for addition in additions {
            let Some(without) = self.without(number, &addition, pool) else { return };
            let misfit = log_error_ratio(&pool.scores.validation, &pool.scores.hypotheses[without].validation);
            missed.push((misfit, addition));
        }
        missed.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, addition) in missed {
            let Some(without) = self.without(number, &addition, pool) else { return };
            number = without;
        }
    }
}
