//! The probability that a named effect is there.

use super::scores::EffectScore;
use super::{Kind, Scores, Verdict};

/// Share of the effects that were there, of those named alone by a verdict that leaves something unexplained. A law outside the
/// catalogue is often imitated by one effect of it. Stored machines: `docs/blind-benchmark.md`.
const ALONE_AND_UNEXPLAINED: f64 = 0.05;

/// The same for effects that are named together. No single law imitates several effects at once.
const TOGETHER_AND_UNEXPLAINED: f64 = 0.8;

/// Probability that `effect` of the favoured hypothesis is there: the share of resampled recordings on which the best admissible
/// hypothesis has it, times the share of such effects that were there on machines with a known answer.
pub fn presence(scores: &Scores, verdict: &Verdict, effect: &EffectScore) -> f64 {
    let rows = scores.hypotheses.iter().zip(&verdict.standings);
    let share: f64 = rows.filter(|(row, _)| row.has(effect)).map(|(_, standing)| standing.is_first).sum();
    let together = scores.hypotheses.get(verdict.best).map_or(0, |best| best.effects.len());
    let trust = match (verdict.kind, together) {
        (Kind::MissingEffect, _) => 1.0,
        (Kind::Adequate, _) | (Kind::Unexplained, 0..2) => ALONE_AND_UNEXPLAINED,
        (Kind::Unexplained, _) => TOGETHER_AND_UNEXPLAINED,
    };
    (share * trust).clamp(0.0, 1.0)
}
