//! The probability that a named effect is there.

use super::scores::EffectScore;
use super::{Kind, Scores, Verdict};

/// Share of the effects that were there, of those named alone, by two and by more by a verdict that leaves something unexplained. A
/// law outside the catalogue is often imitated by one effect of it, or by two, and hardly by three. From stored machines, see
/// `docs/blind-benchmark.md`: 2 of 37, 3 of 18 and 9 of 12.
const WHEN_UNEXPLAINED: [f64; 3] = [0.05, 0.2, 0.7];

/// Probability that `effect` is there: the share of resampled recordings on which the best admissible
/// hypothesis has it, times the share of such effects that were there on machines with a known answer.
pub fn presence(scores: &Scores, verdict: &Verdict, effect: &EffectScore) -> f64 {
    let rows = scores.hypotheses.iter().zip(&verdict.standings);
    let share: f64 = rows.filter(|(row, _)| row.has(effect)).map(|(_, standing)| standing.is_first).sum();
    let together = scores.hypotheses.get(verdict.best).map_or(0, |best| best.effects.len());
    let trust = match verdict.kind {
        Kind::MissingEffect => 1.0,
        Kind::Adequate => WHEN_UNEXPLAINED[0],
        Kind::Unexplained => WHEN_UNEXPLAINED[together.clamp(1, WHEN_UNEXPLAINED.len()) - 1],
    };
    (share * trust).clamp(0.0, 1.0)
}
