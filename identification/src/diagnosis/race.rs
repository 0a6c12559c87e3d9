//! All candidates run a short race; the first few are fitted to the end.
//!
//! A full fit of every effect at every place would take minutes. One simulation with sensitivities already tells which
//! effects promise nothing, three steps of a fit how much of the error the others can take away: the evidence itself is
//! always from full fits.

use std::sync::atomic::{AtomicUsize, Ordering};

use excavator_model::effects::{Effect, Site};
use excavator_model::recording::Recording;
use excavator_model::{ModelEffect, addition_name, site_name};
use rayon::prelude::*;

use super::both_sides::has_seen_both_sides;
use super::candidate::{CandidateError, best_start};
use super::evidence::joint_significance;
use super::inclusion::inclusion;
use super::own_windows::{evaluate_in_own_windows, has_window};
use super::starts::acts_in_a_window;
use super::track::{Track, short};
use super::{Candidate, DiagnosisSettings, Evidence, Unpromising, compare_losses};
use crate::fit::{Fit, fit, fit_predicted};

/// What became of all candidates.
#[derive(Default)]
pub(super) struct Round {
    /// Those that were fitted, best on validation first.
    pub fitted: Vec<Candidate>,
    /// Those not worth a fit.
    pub unpromising: Vec<Unpromising>,
    /// Those that could not be fitted, with the reason.
    pub failed: Vec<(String, CandidateError)>,
}

/// How an effect left the race.
enum Outcome {
    Ran(Box<Runner>),
    Unpromising(Unpromising),
    Failed(CandidateError),
}

/// A candidate that ran the race.
struct Runner {
    physics: &'static dyn Effect,
    site: Site,
    place: String,
    /// After the race's steps.
    fit: Fit,
    /// Fall of the loss on the identification recordings in those.
    gain: f64,
}

/// Losses that differ by less belong to models that behave alike. Of 627 effects that ran on 40 blind machines this would
/// have left behind 211: none was hidden in its machine, and the best of them gained 0.3.
const NEXT_TO_BASE: f64 = 1.2;

/// A share of the loss that does not end the search for something better.
const LITTLE: f64 = 0.25;

/// The share that right effects take away, and more.
const MOST: f64 = 0.8;

/// What right effects leave at most where nothing but noise is left. A twin of theirs can take more than [`MOST`] and leaves more
/// than this: a contact force took 87 % of what a load of 3 kg had brought, and left 0.18.
const CLEAN: f64 = 0.1;

/// What candidates are measured against and on.
pub(super) struct Race<'a> {
    /// The model without them, fitted to the identification recordings.
    pub base: &'a Fit,
    /// The same on the validation recordings.
    pub base_validation: &'a Fit,
    /// Recordings that are fitted.
    pub identification: &'a [&'a Recording],
    /// Recordings that evidence is taken from.
    pub validation: &'a [&'a Recording],
    /// Whether the model without them is adequate already.
    pub base_is_adequate: bool,
    /// Fall of the loss that makes a candidate worth naming.
    pub least_gain: f64,
    /// Thresholds.
    pub settings: &'a DiagnosisSettings,
}

impl Race<'_> {
    /// Tries all additions, best on validation first.
    pub fn run(&self, wanted: &[(&'static dyn Effect, Site)], progress: &(dyn Fn(&str, f64) + Sync)) -> Round {
        let hard = Track::hard(self);
        let machine = &self.base.model.machine;
        let needs_all = |&(physics, site): &(&'static dyn Effect, Site)| acts_in_a_window(physics, machine, site);
        // A window of time is one of a whole recording.
        let whole = Track::whole(self);
        let done = AtomicUsize::new(0);
        // Full fits take about a third of the time.
        let total = wanted.len() as f64 * 1.5;
        let advance = |name: &str| progress(name, (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / total);

        // The longest first, or one core ends with it alone.
        let mut wanted = wanted.to_vec();
        wanted.sort_by_key(|addition| !needs_all(addition));
        let outcomes: Vec<(String, Outcome)> = wanted
            .into_par_iter()
            .map(|(physics, site)| {
                let place = site_name(machine, site).to_string();
                let name = addition_name(physics, &place);
                let track = hard.as_ref().filter(|_| !needs_all(&(physics, site))).unwrap_or(&whole);
                let outcome = self.heat(physics, site, place, track).unwrap_or_else(Outcome::Failed);
                advance(&name);
                (name, outcome)
            })
            .collect();
        let mut round = Round::default();
        let mut runners = Vec::new();
        for (name, outcome) in outcomes {
            match outcome {
                Outcome::Ran(runner) => runners.push(*runner),
                Outcome::Unpromising(effect) => round.unpromising.push(effect),
                Outcome::Failed(error) => round.failed.push((name, error)),
            }
        }
        runners.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let best = runners.first().map_or(0.0, |runner| runner.gain);
        let finalist = |(position, runner): (usize, &Runner)| {
            runner.gain >= self.least_gain / 4.0
                && (position < self.settings.finalists || best - runner.gain < self.settings.finalist_margin)
        };
        let finalists = runners.iter().enumerate().filter(|&entry| finalist(entry)).count();
        let others = runners.split_off(finalists);
        self.to_the_end(runners, &mut round, &advance);
        let (arrived, mut on_their_way): (Vec<Runner>, Vec<Runner>) =
            others.into_iter().partition(|runner| runner.fit.converged);
        let mut others = on_their_way.split_off(self.further_finalists(&round, &on_their_way, best));
        others.extend(arrived);
        // An effect with a threshold may need a dozen steps until it gains what it can: before another name takes its place, or
        // nothing is said to explain the error, those that were still on their way get theirs.
        self.to_the_end(on_their_way, &mut round, &advance);
        round.unpromising.extend(others.into_iter().map(|runner| Unpromising {
            physics: runner.physics,
            place: runner.place,
            promised_gain: runner.gain,
        }));
        round.unpromising.sort_by(|a, b| b.promised_gain.total_cmp(&a.promised_gain));
        round.fitted.sort_by(|a, b| b.evidence.gain.total_cmp(&a.evidence.gain));
        mark_ties(&mut round.fitted, self.settings);
        begin_with_determined(&mut round.fitted);
        let shares = inclusion(self.base_validation, &round.fitted, self.least_gain);
        for (candidate, share) in round.fitted.iter_mut().zip(shares) {
            candidate.inclusion = share;
        }
        round
    }

    /// How many more candidates deserve a full fit, where something is missing: of those `on_their_way`, best first, in a race that
    /// the best won with a gain of `best`.
    fn further_finalists(&self, round: &Round, on_their_way: &[Runner], best: f64) -> usize {
        let accepted = || round.fitted.iter().filter(|candidate| candidate.accepted);
        let gain = accepted().map(|candidate| candidate.evidence.gain).fold(0.0, f64::max);
        let left = accepted().map(|candidate| candidate.validation.loss()).fold(f64::INFINITY, f64::min);
        let share = gain / self.base_validation.loss();
        let some = self.settings.further_finalists.min(on_their_way.len());
        if self.base_is_adequate {
            0
        } else if share < LITTLE {
            on_their_way.len()
        } else if share < MOST {
            some
        } else if left > CLEAN {
            on_their_way[..some].iter().filter(|runner| runner.gain > LITTLE * best).count()
        } else {
            0
        }
    }

    /// Full fits of candidates that ran the race, into `round`.
    fn to_the_end(&self, runners: Vec<Runner>, round: &mut Round, advance: &(dyn Fn(&str) + Sync)) {
        let full: Vec<(String, Result<Candidate, CandidateError>)> = runners
            .into_par_iter()
            .map(|runner| {
                let name = addition_name(runner.physics, &runner.place);
                let candidate = self.judged(runner);
                advance(&name);
                (name, candidate)
            })
            .collect();
        for (name, candidate) in full {
            match candidate {
                Ok(candidate) => round.fitted.push(candidate),
                Err(error) => round.failed.push((name, error)),
            }
        }
    }

    /// A few steps from the start that promises most.
    fn heat(
        &self,
        physics: &'static dyn Effect,
        site: Site,
        place: String,
        track: &Track,
    ) -> Result<Outcome, CandidateError> {
        let recordings: Vec<&Recording> = track.recordings.iter().collect();
        let start = best_start(&track.base.model, physics, site, &recordings, &self.settings.fit)?;
        let promised_gain = track.base.loss() - start.promise.loss_after;
        // Only from a start next to the base can the promise of one step be trusted.
        let is_trusted = (start.promise.loss_before - track.start_loss).abs() < NEXT_TO_BASE;
        if is_trusted && promised_gain < self.least_gain / 4.0 {
            return Ok(Outcome::Unpromising(Unpromising { physics, place, promised_gain }));
        }
        let fit = fit_predicted(&start.model, start.promise, &recordings, &short(self.settings))?;
        let gain = compare_losses(&track.base, &fit).gain;
        Ok(Outcome::Ran(Box::new(Runner { physics, site, place, fit, gain })))
    }

    /// A candidate fitted to the end, with its evidence.
    fn judged(&self, runner: Runner) -> Result<Candidate, CandidateError> {
        let settings = &self.settings.fit;
        let Runner { physics, site, fit: start, .. } = runner;
        let fit = fit(&start.model, self.identification, settings)?;
        let validation = evaluate_in_own_windows(&fit.model, &self.base_validation.model, self.validation, settings)?;
        let fitted = compare_losses(self.base, &fit);
        let mut candidate = Candidate::new(physics, site, [fit, validation], [self.base, self.base_validation]);
        // What has a window of its own in each recording is fitted to each: neither says more than the other.
        let (model, evidence) = (&candidate.fit.model, &mut candidate.evidence);
        if model.effects.last().is_some_and(has_window) && fitted.gain < evidence.gain {
            let significance = fitted.significance.min(evidence.significance);
            *evidence = Evidence { gain: fitted.gain, significance };
        }
        candidate.accepted = evidence.gain >= self.least_gain
            && fitted.gain >= self.least_gain / 2.0
            && evidence.significance >= self.settings.least_significance
            && joint_significance(*evidence, fitted) >= self.settings.least_joint_significance
            && model.effects.last().is_some_and(ModelEffect::is_worth_a_name)
            && has_seen_both_sides(model, self.identification);
        Ok(candidate)
    }
}

fn mark_ties(candidates: &mut [Candidate], settings: &DiagnosisSettings) {
    let mut accepted = candidates.iter_mut().filter(|candidate| candidate.accepted);
    let Some(first) = accepted.next() else { return };
    for other in accepted {
        let lead = compare_losses(&other.validation, &first.validation);
        // A relief valve that is always open is a leak: who needs more parameters has to explain more with them.
        let least_lead = if first.parameter_count() < other.parameter_count() { 0.0 } else { settings.tie_gain };
        other.tied_with_first = lead.gain < least_lead || lead.significance < settings.tie_significance;
        first.tied_with_first |= other.tied_with_first;
    }
}

/// A payload whose mass nobody can tell, on a level axis with an incline that nobody can tell, is a constant force: it stands
/// behind what is tied with it and has a number.
fn begin_with_determined(candidates: &mut [Candidate]) {
    let Some(first) = candidates.iter().position(|candidate| candidate.tied_with_first) else { return };
    if candidates[first].is_determined() {
        return;
    }
    let is_other = |candidate: &Candidate| candidate.tied_with_first && candidate.is_determined();
    if let Some(other) = candidates.iter().position(is_other) {
        candidates[first..=other].rotate_right(1);
    }
}
