//! Tries proposed laws like the effects of a catalogue.

use super::pool::{Move, Pool};
use super::progress::Milestones;
use super::stepwise::Stepwise;
use super::{Addition, Effort};
use crate::decision::Policy;

/// Tries `laws` as additions to trial `number` of the pool: a few steps of each, then full fits of the best. The
/// results join the pool under the same rules as effects of a catalogue.
pub(crate) fn try_laws(
    pool: &mut Pool<'_>,
    number: usize,
    laws: Vec<Addition>,
    effort: &Effort,
    policy: &Policy,
    progress: &(dyn Fn(&str, f64) + Sync),
) {
    let milestones = Milestones::new(progress);
    // The results for the catalogue are kept.
    let (unpromising, failed) = (std::mem::take(&mut pool.unpromising), std::mem::take(&mut pool.failed));
    Stepwise { effort, policy, milestones: &milestones }.screen(number, laws, policy.least_improvement, pool);
    (pool.unpromising, pool.failed) = (unpromising, failed);
}

/// Fits each effect of the favoured hypotheses of several effects without the others, from its values beside them. The
/// results join the pool.
pub(crate) fn try_each_alone(
    pool: &mut Pool<'_>,
    effort: &Effort,
    policy: &Policy,
    progress: &(dyn Fn(&str, f64) + Sync),
) {
    let milestones = Milestones::new(progress);
    let stepwise = Stepwise { effort, policy, milestones: &milestones };
    let verdict = pool.verdict(policy);
    let mut several: Vec<usize> = (1..pool.trials.len())
        .filter(|&number| pool.trials[number].additions.len() > 1 && verdict.standings[number].improvement > 0.0)
        .filter(|&number| !pool.was_done(Move::Prune, number))
        .collect();
    several.sort_by(|&a, &b| verdict.standings[a].log_error_ratio.total_cmp(&verdict.standings[b].log_error_ratio));
    several.truncate(MOST_ALONE);
    for number in several {
        stepwise.take(Move::Prune, number, pool);
    }
}

/// Largest number of hypotheses whose effects are fitted alone: as many as are listed.
const MOST_ALONE: usize = 10;
