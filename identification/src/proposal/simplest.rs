//! Of laws that predict equally well, the simplest.

use crate::decision::{Reason, Verdict};
use crate::search::Trial;

/// The verdict with the simplest hypothesis of its set first, and those away that predict no better with more parameters: a coefficient
/// that may be zero, a threshold where nothing is.
pub(super) fn simplest_first(mut verdict: Verdict, trials: &[Trial]) -> Verdict {
    let complexity = |number: &usize| trials.get(*number).map_or(usize::MAX, parameters_of_laws);
    let Some(fewest) = verdict.set.iter().map(complexity).min() else { return verdict };
    verdict.set.retain(|number| complexity(number) == fewest);
    verdict.set.sort_by(|a, b| {
        let ratio = |number: usize| verdict.standings[number].log_error_ratio;
        ratio(*a).total_cmp(&ratio(*b))
    });
    verdict.best = verdict.set[0];
    verdict.reasons.retain(|reason| !matches!(reason, Reason::Indistinguishable { .. }));
    if verdict.set.len() > 1 {
        verdict.reasons.push(Reason::Indistinguishable { hypotheses: verdict.set.clone() });
    }
    verdict
}

/// Number of parameters that the effects of a trial add.
pub(super) fn parameters_of_laws(trial: &Trial) -> usize {
    let effects = trial.additions.iter().filter_map(|addition| trial.effect(addition));
    effects.flat_map(|effect| &effect.parameters).filter(|parameter| !parameter.known).count()
}
