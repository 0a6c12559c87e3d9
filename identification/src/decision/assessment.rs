//! Compares each hypothesis with the given model and with the hypotheses that have fewer effects.

use super::resampling::{Resampled, Resampling, mean};
use super::scores::{Bound, EffectScore, Hypothesis, Scores};
use super::statistic::block_costs;
use super::{Policy, Standing};

/// One hypothesis, assessed.
pub(super) struct Assessed<'a> {
    /// The hypothesis.
    pub hypothesis: &'a Hypothesis,
    /// Mean of its block costs, for the recordings and for each resampling.
    pub resampled: Resampled,
    /// Log error ratio on the validation recordings, beyond the error that the input readings cause.
    pub validation: f64,
    /// The same on the identification recordings.
    pub identification: f64,
    /// Whether each of its effects is needed, significant, and of sensible size.
    pub is_admissible: bool,
}

/// All hypotheses, assessed, in the order of the scores.
pub(super) fn assess<'a>(scores: &'a Scores, policy: &Policy, given_is_adequate: bool) -> Vec<Assessed<'a>> {
    let resampling = Resampling::new(&[scores.identification.blocks.len(), scores.validation.blocks.len()]);
    let mut assessed: Vec<Assessed<'a>> = scores
        .hypotheses
        .iter()
        .map(|hypothesis| {
            let costs = block_costs(scores, hypothesis);
            let [identification, validation] = [mean(&costs[0]), mean(&costs[1])];
            let resampled = resampling.of(&costs);
            Assessed { hypothesis, resampled, validation, identification, is_admissible: false }
        })
        .collect();
    let admissible: Vec<bool> =
        (0..assessed.len()).map(|number| is_admissible(&assessed, number, policy, given_is_adequate)).collect();
    assessed.iter_mut().zip(admissible).for_each(|(one, is_admissible)| one.is_admissible = is_admissible);
    let distorted: Vec<bool> = (0..assessed.len()).map(|number| is_distorted(&assessed, number)).collect();
    assessed.iter_mut().zip(distorted).for_each(|(one, is_distorted)| one.is_admissible &= !is_distorted);
    assessed
}

/// Whether a hypothesis is near the recordings only because masses, gains or the bulk modulus left the data sheet: one effect more
/// brings them back.
fn is_distorted(all: &[Assessed<'_>], number: usize) -> bool {
    let own = all[number].hypothesis;
    !own.is_plausible
        && all.iter().any(|more| more.is_admissible && more.hypothesis.is_plausible && more.hypothesis.extends(own))
}

fn is_admissible(all: &[Assessed<'_>], number: usize, policy: &Policy, given_is_adequate: bool) -> bool {
    let own = &all[number];
    let effects = &own.hypothesis.effects;
    !effects.is_empty()
        && effects.iter().all(is_sensible)
        && all.iter().filter(|less| own.hypothesis.extends(less.hypothesis)).all(|less| {
            let (least, significance) = wanted(less.hypothesis, own.hypothesis, policy, given_is_adequate);
            improves(less, own, [least, policy.share_where_fitted * least], significance)
        })
}

/// The improvement that `more` must bring over `less`, and by how many standard errors.
fn wanted(less: &Hypothesis, more: &Hypothesis, policy: &Policy, given_is_adequate: bool) -> (f64, f64) {
    let is_given = less.effects.is_empty();
    if is_given && given_is_adequate {
        (policy.least_improvement_when_adequate, policy.least_significance)
    } else if !is_given && more.is_plausible && !less.is_plausible {
        // Other parameters pay for the effect that it lacks, so its error does not tell how large that effect is.
        (0.0, policy.least_significance_over_implausible)
    } else {
        (policy.least_improvement, policy.least_significance)
    }
}

/// Whether `more` explains what `less` does not. The improvement must reach these values on the validation and on the identification
/// recordings, and `least_significance` standard errors on all together.
fn improves(
    less: &Assessed<'_>,
    more: &Assessed<'_>,
    [on_validation, on_identification]: [f64; 2],
    least_significance: f64,
) -> bool {
    let (_, significance) = less.resampled.improvement(&more.resampled);
    less.improvement(more) >= on_validation
        && less.identification - more.identification >= on_identification
        && significance >= least_significance
}

/// Whether an effect acts as described in these recordings and has a plausible size.
fn is_sensible(effect: &EffectScore) -> bool {
    let at = |bound: Bound| effect.parameters.iter().filter(|one| one.at_bound == Some(bound)).count();
    let fitted = effect.parameters.iter().filter(|one| one.at_bound.is_some() || one.margin_95.is_some()).count();
    // Some of several coefficients may be zero, but none may exceed its plausible bound.
    let is_at_its_bounds = at(Bound::Upper) > 0 || fitted > 0 && at(Bound::Lower) == fitted;
    effect.is_practically_significant && effect.is_seen_from_both_sides && !is_at_its_bounds
}

impl Assessed<'_> {
    /// By how much `other` is better on the validation recordings. A transient effect is fitted to each recording and predicts no
    /// other one, so the smaller improvement of the two kinds of recordings counts.
    pub fn improvement(&self, other: &Assessed<'_>) -> f64 {
        let (validation, identification) =
            (self.validation - other.validation, self.identification - other.identification);
        let is_transient = other.hypothesis.effects.iter().any(|one| one.is_transient && !self.hypothesis.has(one));
        if is_transient { validation.min(identification) } else { validation }
    }

    /// Whether the recordings determine at least one parameter of its effects. For example, a payload of undetermined mass on an
    /// undetermined incline is just a constant force.
    pub fn is_determined(&self) -> bool {
        let parameters = self.hypothesis.effects.iter().flat_map(|effect| &effect.parameters);
        parameters.into_iter().any(|one| one.margin_95.is_some_and(|margin| margin < one.value.abs()))
    }

    /// Its comparison with the given model.
    pub fn standing(&self, given: &Assessed<'_>) -> Standing {
        Standing {
            log_error_ratio: self.validation,
            improvement: given.improvement(self),
            identification_improvement: given.identification - self.identification,
            significance: given.resampled.improvement(&self.resampled).1,
            is_admissible: self.is_admissible,
            set_p_value: None,
            is_first: 0.0,
        }
    }
}
