//! Sets of several effects that the flow balances ask for, in the whole machine.

use excavator_model::Model;

use super::balances::{FlowSet, FlowSets, unread, with_flows_of};
use super::pool::{Move, Pool};
use super::stepwise::Stepwise;
use super::{Addition, Effort};
use crate::decision::{Kind, Policy, leaves_nothing, log_error_ratio};
use crate::fit::{FitSettings, with_nuisances};

impl Stepwise<'_> {
    /// Fits the sets of the flow balances to the whole machine, extends the best while it leaves something, and takes away what
    /// is not needed. Returns whether several effects then explain the recordings.
    pub fn join(&self, model: &Model, sets: &FlowSets<'_>, pool: &mut Pool<'_>) -> bool {
        self.fit_joined(model, &sets.best, pool);
        while let Some((next, number)) = next_of_joined(pool, self.effort, self.policy) {
            self.take(next, number, pool);
        }
        let verdict = pool.verdict(self.policy);
        if verdict.kind != Kind::MissingEffect || pool.trials[verdict.best].additions.len() < 2 {
            return false;
        }
        // The sets of the balances have no single rivals that the search could exchange.
        self.fit_rivals(verdict.best, sets, pool);
        if !leaves_nothing(&pool.scores, verdict.best, self.policy) {
            self.take(Move::Swap, verdict.best, pool);
        }
        // What changes the meaning of a signal was taken as measured. It counts if it does about as much alone.
        let explained = pool.given().fit.loss() - pool.trials[verdict.best].fit.loss();
        let unread = unread(&pool.given().fit.model, pool.identification());
        self.screen(0, unread, explained.max(self.policy.least_improvement), pool);
        true
    }

    /// Fits hypothesis `number` with the rivals of its effects on the flows in their place.
    fn fit_rivals(&self, number: usize, sets: &FlowSets<'_>, pool: &mut Pool<'_>) {
        let Some(first) = sets.best.first() else { return };
        self.milestones.tell("rivals in the flow balances", 0.5);
        let trial = pool.trials[number].clone();
        let give_up_above = trial.fit.loss() + self.effort.needed_beyond_doubt;
        let settings = FitSettings { give_up_above, maximum_steps: self.effort.settling_steps, ..self.effort.fit };
        for rival in sets.rivals() {
            let replaced = first.additions.iter().find(|one| !rival.additions.contains(one));
            let replacing = rival.additions.iter().find(|one| !first.additions.contains(one));
            let (Some(replaced), Some(replacing)) = (replaced, replacing) else { continue };
            if !trial.adds(replaced) || trial.adds(replacing) {
                continue;
            }
            let rest = trial.additions.iter().filter(|one| *one != replaced).chain([replacing]);
            let additions: Vec<Addition> = rest.cloned().collect();
            if pool.find_additions(&additions).is_some() {
                continue;
            }
            let mut start = trial.model_without(replaced);
            let found = rival.model.effect(&replacing.physics.card().name, replacing.site).cloned();
            start.effects.extend(found);
            let fitted = pool.fitted(additions, &start, &trial.validation.model, &settings);
            fitted.into_iter().for_each(|one| pool.put(one));
        }
    }

    /// Without its missing effects, the fit of the given model may have moved masses and frictions far away. So the forces start
    /// from the data sheet, and from that fit only if this leaves something.
    fn fit_joined(&self, model: &Model, sets: &[FlowSet], pool: &mut Pool<'_>) {
        let several = sets.iter().filter(|set| !set.additions.is_empty()).take(self.effort.joined_sets);
        let plain = with_nuisances(model, pool.identification());
        let fitted = pool.given().fit.model.clone();
        for set in several {
            let mut least = f64::INFINITY;
            for forces in [&plain, &fitted] {
                self.milestones.tell("the effects of the flow balances together", 0.5);
                let (maximum_steps, give_up_above) = (self.effort.settling_steps, least);
                let settings = FitSettings { maximum_steps, give_up_above, ..self.effort.fit };
                let start = with_flows_of(forces, &set.model);
                let known = &pool.given().validation.model;
                let Some(trial) = pool.fitted(set.additions.clone(), &start, known, &settings) else { continue };
                // Of two fits of the same set, the pool keeps the better one.
                least = least.min(trial.fit.loss());
                pool.put(trial);
                let last = pool.find_additions(&set.additions);
                if last.is_some_and(|last| leaves_nothing(&pool.scores, last, self.policy)) {
                    return;
                }
            }
        }
    }
}

/// The next move from what the flow balances ask for: more effects while it leaves something, then fewer. The decision would
/// rather have few effects, and take away what looks small beside the others that are still missing.
fn next_of_joined(pool: &Pool<'_>, effort: &Effort, policy: &Policy) -> Option<(Move, usize)> {
    let misfit = |number: usize| log_error_ratio(&pool.scores.validation, &pool.scores.hypotheses[number].validation);
    let best = (1..pool.trials.len()).min_by(|&a, &b| misfit(a).total_cmp(&misfit(b)))?;
    let trial = &pool.trials[best];
    let is_open = |what: &Move| !pool.was_done(*what, best);
    let mut moves = Vec::new();
    if !trial.fit.converged {
        moves.push(Move::Settle);
    }
    if trial.additions.len() < effort.most_effects && !leaves_nothing(&pool.scores, best, policy) {
        moves.extend([Move::ExtendForces, Move::Extend]);
    }
    if trial.additions.len() > 1 {
        moves.push(Move::Prune);
    }
    moves.into_iter().find(is_open).map(|what| (what, best))
}
