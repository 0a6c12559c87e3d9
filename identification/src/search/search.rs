//! Searches for hypotheses, with scores, for what a model is missing.
//!
//! A local search over sets of effects. [`crate::decision::decide`] selects the hypothesis that the scores so far
//! favour. The search then tries its neighbours: one effect more, one effect less, one effect exchanged. It ends when
//! all neighbours of the favoured one were tried, or when nothing is left that another effect could explain. The effect
//! that lowers the error most need not be a missing one: if two effects are missing, a third one may look better than
//! either. That is why effects are also removed and exchanged.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::balances::{flow_sets, flows_are_measured};
use super::given::{First, better_given, first_fit, second_fit};
use super::pool::{Move, Pool};
use super::stepwise::Stepwise;
use super::{Effort, Trial, progress::Milestones};
use crate::decision::{Kind, Policy, Verdict, leaves_nothing};
use crate::fit::{Fit, FitError};

/// Tries effects that `model` may be missing. Parameters are fitted to `identification`; scores also cover
/// `validation`. `progress` is called with the current activity and the fraction done.
///
/// # Errors
/// [`FitError`] if the given model cannot be fitted or evaluated.
pub fn search<'a>(
    model: &Model,
    identification: &'a [&'a Recording],
    validation: &'a [&'a Recording],
    effort: &Effort,
    policy: &Policy,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Pool<'a>, FitError> {
    let model = &model.clone().with_limits_around_given();
    let milestones = Milestones::new(progress);
    milestones.tell("fit of the given model", 0.0);
    let First { fit, is_trusted } = first_fit(model, identification, &effort.fit)?;
    milestones.pass();
    let steps = Stepwise { effort, policy, milestones: &milestones };
    let mut pool = Pool::new(model, Trial::given(fit, validation, &effort.fit)?, identification, validation);
    pool.look_at_inputs(effort, policy);
    if leaves_nothing(&pool.scores, 0, policy) {
        return Ok(pool);
    }
    let all: Vec<&Recording> = identification.iter().chain(validation).copied().collect();
    let is_explained = flows_are_measured(model, &all) && {
        milestones.tell("the flow balances by themselves", 0.0);
        let sets = flow_sets(model, effort.most_effects, identification, validation);
        milestones.pass();
        sets.is_some_and(|sets| steps.join(model, &sets, &mut pool))
    };
    if !is_explained {
        milestones.tell("fit of the given model", 0.5);
        let loss = pool.given().fit.loss();
        let second = if is_trusted { None } else { second_fit(model, identification, &effort.fit, loss) };
        pool = extended(pool, second, &steps)?;
        if leaves_nothing(&pool.scores, 0, policy) {
            return Ok(pool);
        }
    }
    while let Some((next, number)) = next_move(&pool, effort, policy) {
        steps.take(next, number, &mut pool);
        milestones.pass();
    }
    steps.complete_path(&mut pool);
    Ok(pool)
}

/// Adds every effect to the given model; again whenever that shows a better fit of it, which `better` may be at first.
fn extended<'a>(mut pool: Pool<'a>, mut better: Option<Fit>, steps: &Stepwise<'_>) -> Result<Pool<'a>, FitError> {
    let (effort, policy) = (steps.effort, steps.policy);
    for _ in 0..=effort.most_restarts {
        if let Some(fit) = better.take() {
            pool = pool.restarted(&effort.fit, fit)?;
            pool.look_at_inputs(effort, policy);
            if leaves_nothing(&pool.scores, 0, policy) {
                break;
            }
        }
        steps.take(Move::Extend, 0, &mut pool);
        better = better_given(&pool, effort);
        if better.is_none() {
            break;
        }
    }
    Ok(pool)
}

/// The next move and its hypothesis. Returns `None` when every move that could change the verdict was tried.
fn next_move(pool: &Pool<'_>, effort: &Effort, policy: &Policy) -> Option<(Move, usize)> {
    let verdict = pool.verdict(policy);
    let wanted = moves_of(&verdict, pool, effort, policy);
    wanted.into_iter().find(|&(what, number)| !pool.was_done(what, number))
}

fn moves_of(verdict: &Verdict, pool: &Pool<'_>, effort: &Effort, policy: &Policy) -> Vec<(Move, usize)> {
    let (best, mut moves) = (verdict.best, Vec::new());
    let effects = pool.trials[best].additions.len();
    if best != 0 {
        if !pool.trials[best].fit.converged {
            moves.push((Move::Settle, best));
        }
        if effects > 1 {
            moves.push((Move::Prune, best));
        }
        if effects < effort.most_effects && !leaves_nothing(&pool.scores, best, policy) {
            moves.push((Move::Extend, best));
        }
    }
    if verdict.kind == Kind::Unexplained {
        moves.extend(second_beginnings(verdict, pool, effort));
        moves.push((Move::Structural, 0));
    }
    if best != 0 && verdict.kind == Kind::MissingEffect {
        moves.push((Move::Exchange, best));
        moves.push((Move::Structural, best));
    }
    moves
}

/// Single effects that did nearly as well as the best one and are not part of the best hypothesis.
fn second_beginnings(verdict: &Verdict, pool: &Pool<'_>, effort: &Effort) -> Vec<(Move, usize)> {
    let best = &pool.trials[verdict.best];
    let mut singles: Vec<usize> = (1..pool.trials.len())
        .filter(|&number| pool.trials[number].additions.len() == 1 && verdict.standings[number].is_admissible)
        .collect();
    singles.sort_by(|&a, &b| verdict.standings[b].improvement.total_cmp(&verdict.standings[a].improvement));
    let Some(&first) = singles.first() else { return Vec::new() };
    let least = effort.rival_share * verdict.standings[first].improvement;
    let other = |number: &usize| {
        verdict.standings[*number].improvement >= least
            && !pool.trials[*number].additions.iter().all(|one| best.adds(one))
    };
    let begun = singles.iter().filter(|&&number| other(&number) && pool.was_done(Move::Extend, number)).count();
    let left = effort.most_second_beginnings.saturating_sub(begun);
    let open = singles.into_iter().filter(other).filter(|&number| !pool.was_done(Move::Extend, number));
    open.take(left).map(|number| (Move::Extend, number)).collect()
}
