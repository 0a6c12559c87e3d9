//! The decision: a pure function of the scores.

use super::adequacy::adequacy;
use super::assessment::{Assessed, assess};
use super::confidence_set::set_p_values;
use super::resampling::DRAWS;
use super::scores::EffectScore;
use super::{Kind, Policy, Reason, Scores, Standing, Verdict};

/// Decides which effect the given model lacks.
///
/// 1. The given model is adequate if its error on the validation recordings is noise, too small to act on, or within the input
///    readings.
/// 2. A hypothesis is admissible if each of its effects is needed, significant and of sensible size.
/// 3. The model confidence set holds the admissible hypotheses that cannot be distinguished from the best one; of these, the ones
///    with the fewest effects stay. If the effects that all of them share leave no more than noise, these are the only one.
/// 4. The first of them explains the recordings if it leaves little error. A structural effect in the set forbids an attribution.
///
/// ```
/// use excavator_identification::decision::scores::{Block, FORMAT, Hypothesis, InstrumentScale, Misfit, Side};
/// use excavator_identification::prelude::*;
///
/// // One displacement, read 85 times in each of 40 blocks of half a second; the given model leaves the noise and no more.
/// let instrument = InstrumentScale { name: "arm.displacement".into(), unit: "m".into(), noise: 1e-4, spread: 1e-2 };
/// let block = |number: i32| Block { recording: 0, begin_s: 0.5 * f64::from(number), readings: vec![85] };
/// let side = Side {
///     sample_interval_s: 2e-3,
///     instruments: vec![instrument],
///     input_floor: Vec::new(),
///     blocks: (0..40).map(block).collect(),
/// };
/// let misfit = Misfit { error_ratios: vec![vec![1.0]; 40] };
/// let given = Hypothesis {
///     effects: Vec::new(),
///     nuisances: Vec::new(),
///     is_plausible: true,
///     identification: misfit.clone(),
///     validation: misfit,
///     parameter_count: 12,
///     seconds: 1.0,
/// };
/// let scores = Scores {
///     format: FORMAT,
///     machine: "zx30u-arm".into(),
///     identification: side.clone(),
///     validation: side,
///     hypotheses: vec![given],
/// };
/// let verdict = decide(&scores, &Policy::default());
/// assert_eq!(verdict.kind, Kind::Adequate);
/// ```
pub fn decide(scores: &Scores, policy: &Policy) -> Verdict {
    let adequacy = adequacy(scores, policy);
    let assessed = assess(scores, policy, adequacy.is_adequate);
    let standings = standings(&assessed);
    let mut set = confidence_set(&assessed, &standings, policy);
    if let Some(shared) = shared_and_adequate(&assessed, &set, policy) {
        set = vec![shared];
    }
    let candidates: Vec<usize> = with_fewest_effects(&assessed, &set, |one| !one.hypothesis.is_structural());
    let before = assessed[0].validation;
    let favoured = candidates.first().copied().or_else(|| best_candidate(&assessed));
    let Some(best) = favoured else {
        let kind = if adequacy.is_adequate { Kind::Adequate } else { Kind::Unexplained };
        let mut reasons = adequacy.reasons;
        reasons.extend(structural_reason(&assessed, &set, false));
        if kind == Kind::Unexplained {
            reasons.push(Reason::NothingHelps { log_error_ratio: before });
        }
        return Verdict { kind, best: 0, set: Vec::new(), reasons, standings };
    };
    let after = assessed[best].validation;
    let limit = policy.largest_remainder;
    let is_explained = after <= limit.max(limit * before);
    if adequacy.is_beyond_doubt && !is_explained {
        return Verdict { kind: Kind::Adequate, best: 0, set: Vec::new(), reasons: adequacy.reasons, standings };
    }
    let structural = structural_reason(&assessed, &set, candidates.is_empty());
    let kind = if is_explained && structural.is_none() { Kind::MissingEffect } else { Kind::Unexplained };
    let mut reasons: Vec<Reason> = structural.into_iter().collect();
    reasons.push(if is_explained {
        Reason::Explained { before, after, limit }
    } else {
        Reason::PartlyExplained { before, after, limit }
    });
    if candidates.len() > 1 {
        reasons.push(Reason::Indistinguishable { hypotheses: candidates.clone() });
    }
    reasons.extend(adequacy.reasons.into_iter().filter(|reason| matches!(reason, Reason::TooCoarse { .. })));
    let set = if candidates.is_empty() { vec![best] } else { candidates };
    Verdict { kind, best, set, reasons, standings }
}

/// Whether hypothesis `number` leaves too little for another effect to be attributed, which would have to be below sensor noise.
pub fn leaves_nothing(scores: &Scores, number: usize, policy: &Policy) -> bool {
    let hypothesis = &scores.hypotheses[number];
    let sides = [(&scores.identification, &hypothesis.identification), (&scores.validation, &hypothesis.validation)];
    let left = sides.map(|(side, misfit)| super::statistic::log_error_ratio(side, misfit));
    left.into_iter().all(|left| left <= policy.nothing_left)
}

fn standings(assessed: &[Assessed<'_>]) -> Vec<Standing> {
    let mut standings: Vec<Standing> = assessed.iter().map(|one| one.standing(&assessed[0])).collect();
    let admissible: Vec<usize> = (0..assessed.len()).filter(|&number| assessed[number].is_admissible).collect();
    let resampled: Vec<_> = admissible.iter().map(|&number| &assessed[number].resampled).collect();
    for (&number, p_value) in admissible.iter().zip(set_p_values(&resampled)) {
        standings[number].set_p_value = Some(p_value);
    }
    for draw in 0..DRAWS {
        let at = |number: &&usize| assessed[**number].resampled.draws[draw];
        if let Some(&first) = admissible.iter().min_by(|a, b| at(a).total_cmp(&at(b))) {
            standings[first].is_first += 1.0 / DRAWS as f64;
        }
    }
    standings
}

/// Admissible hypotheses that cannot be distinguished from the best one, best first: the difference may be chance, or it is less
/// than a share of the error that the best one leaves.
fn confidence_set(assessed: &[Assessed<'_>], standings: &[Standing], policy: &Policy) -> Vec<usize> {
    let admissible = (0..assessed.len()).filter(|&number| assessed[number].is_admissible);
    let mut ranked: Vec<usize> = admissible.collect();
    ranked.sort_by(|&a, &b| assessed[a].resampled.mean.total_cmp(&assessed[b].resampled.mean));
    let Some(&best) = ranked.first() else { return ranked };
    let doubt = policy.doubtful_share * assessed[best].validation.max(0.0);
    ranked.retain(|&number| {
        let is_in_set = standings[number].set_p_value.is_some_and(|p| p >= policy.set_error);
        let lead = assessed[number].validation - assessed[best].validation;
        number == best || is_in_set || lead < doubt
    });
    ranked
}

/// The admissible hypothesis of exactly the effects that all in `set` share, if it leaves no more than noise: then they differ only
/// in what does not matter.
fn shared_and_adequate(assessed: &[Assessed<'_>], set: &[usize], policy: &Policy) -> Option<usize> {
    let members = || set.iter().map(|&number| assessed[number].hypothesis);
    let first = members().next().filter(|_| set.len() > 1)?;
    let shared: Vec<&EffectScore> =
        first.effects.iter().filter(|effect| members().all(|other| other.has(effect))).collect();
    (1..assessed.len()).find(|&number| {
        let own = &assessed[number];
        own.is_admissible
            && own.validation <= policy.noise_margin
            && own.hypothesis.effects.len() == shared.len()
            && shared.iter().all(|effect| own.hypothesis.has(effect))
    })
}

/// Of the hypotheses in `set` that are `wanted`, those with the fewest effects, the determined ones first.
fn with_fewest_effects(assessed: &[Assessed<'_>], set: &[usize], wanted: impl Fn(&Assessed<'_>) -> bool) -> Vec<usize> {
    let mut wanted: Vec<usize> = set.iter().copied().filter(|&number| wanted(&assessed[number])).collect();
    let fewest = wanted.iter().map(|&number| assessed[number].hypothesis.effects.len()).min();
    wanted.retain(|&number| Some(assessed[number].hypothesis.effects.len()) == fewest);
    wanted.sort_by_key(|&number| !assessed[number].is_determined());
    wanted
}

/// The best admissible hypothesis without a structural effect.
fn best_candidate(assessed: &[Assessed<'_>]) -> Option<usize> {
    let candidates = (0..assessed.len())
        .filter(|&number| assessed[number].is_admissible && !assessed[number].hypothesis.is_structural());
    candidates.min_by(|&a, &b| assessed[a].resampled.mean.total_cmp(&assessed[b].resampled.mean))
}

/// The reason for a structural effect in the set.
fn structural_reason(assessed: &[Assessed<'_>], set: &[usize], is_preferred: bool) -> Option<Reason> {
    let hypothesis = set.iter().copied().find(|&number| assessed[number].hypothesis.is_structural())?;
    Some(Reason::StructuralAlternative { hypothesis, is_preferred })
}
