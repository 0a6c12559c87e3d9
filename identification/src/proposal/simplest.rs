//! Selects the simplest of the laws that predict equally well.

use crate::decision::{Reason, Verdict};
use crate::search::Trial;

/// Log error ratio by which a law may be worse than one with more parameters and still be preferred: 1 % of the squared
/// error. A threshold close to zero may be better by a hundredth of that in every block of time. No test then takes the
/// two laws as equal.
const NEGLIGIBLE: f64 = 0.01;

/// Reduces the verdict's set to its simplest hypotheses. Those that predict no better with more parameters are removed,
/// for example a coefficient that may be zero, or a threshold without an effect. Of equally simple hypotheses those
/// come first that remain physically possible beyond the recorded range: they never put energy into the machine and
/// reverse no opening.
pub(super) fn simplest_first(mut verdict: Verdict, trials: &[Trial], is_possible: &dyn Fn(&Trial) -> bool) -> Verdict {
    let complexity = |number: &usize| trials.get(*number).map_or(usize::MAX, Trial::added_parameters);
    let (own, error) = (complexity(&verdict.best), verdict.standings[verdict.best].log_error_ratio);
    let is_as_good = |number: &usize| {
        let standing = &verdict.standings[*number];
        standing.is_admissible
            && (1..own).contains(&complexity(number))
            && standing.log_error_ratio - error < NEGLIGIBLE
    };
    let as_good: Vec<usize> =
        (0..verdict.standings.len()).filter(is_as_good).filter(|number| !verdict.set.contains(number)).collect();
    verdict.set.extend(as_good);
    let Some(fewest) = verdict.set.iter().map(complexity).min() else { return verdict };
    verdict.set.retain(|number| complexity(number) == fewest);
    let order = |number: &usize| {
        let is_impossible = trials.get(*number).is_some_and(|trial| !is_possible(trial));
        (is_impossible, verdict.standings[*number].log_error_ratio)
    };
    let mut ordered: Vec<(usize, (bool, f64))> = verdict.set.iter().map(|number| (*number, order(number))).collect();
    ordered.sort_by(|(_, a), (_, b)| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    verdict.set = ordered.into_iter().map(|(number, _)| number).collect();
    verdict.best = verdict.set[0];
    verdict.reasons.retain(|reason| !matches!(reason, Reason::Indistinguishable { .. }));
    if verdict.set.len() > 1 {
        verdict.reasons.push(Reason::Indistinguishable { hypotheses: verdict.set.clone() });
    }
    verdict
}
