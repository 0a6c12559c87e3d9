//! The probability that a named effect is there.

use super::scores::EffectScore;
use super::{Kind, Policy, Scores, Verdict};

/// Probability that `effect` is there: the share of resampled recordings on which the best admissible
/// hypothesis has it, times the share of such effects that were there on machines with a known answer.
pub fn presence(scores: &Scores, verdict: &Verdict, effect: &EffectScore, policy: &Policy) -> f64 {
    let rows = scores.hypotheses.iter().zip(&verdict.standings);
    let share: f64 = rows.filter(|(row, _)| row.has(effect)).map(|(_, standing)| standing.is_first).sum();
    let together = scores.hypotheses.get(verdict.best).map_or(0, |best| best.effects.len());
    let trust = match verdict.kind {
        Kind::MissingEffect => 1.0,
        Kind::Adequate => policy.trust_when_unexplained[0],
        Kind::Unexplained => policy.trust_when_unexplained[together.clamp(1, 3) - 1],
    };
    (share * trust).clamp(0.0, 1.0)
}
