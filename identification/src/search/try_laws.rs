//! Tries proposed laws like the effects of a catalogue.

use super::pool::Pool;
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
