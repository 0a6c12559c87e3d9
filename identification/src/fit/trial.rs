//! Tries a step of a fit: simulates it, and refits the initial states of a few segments if the step made them worse.
//!
//! A segment that begins at rest with closed valves can respond to a small change of its initial pressures with a
//! motion that the sensitivities do not predict: friction holds up to a limit. One such segment would cause the step of
//! all others to be rejected repeatedly, with growing damping. Its initial state is a separate unknown, so it is found
//! again at the new parameters, starting from its previous value. The other segments are left as they are.

use nalgebra::DVector;
use rayon::prelude::*;

use super::Segment;
use super::normal_equations::{RawSums, SegmentSums};
use super::problem::Problem;

/// Largest share of segments that may be refitted. If more of them got worse, the step is too long.
const MOST_ASTRAY: f64 = 0.25;
/// Steps of one segment's own fit.
const STEPS: usize = 6;
/// A smaller relative decrease of a segment's loss ends its own fit.
const LEAST_IMPROVEMENT: f64 = 0.01;

/// Present point of a fit: initial states of all segments, and the sums there.
pub(super) struct Reached {
    /// The segments, each with its initial state.
    pub segments: Vec<Segment>,
    /// Sums of each.
    pub raw: Vec<RawSums>,
    /// Their loss with the weights of the step.
    pub loss: f64,
}

/// Loss of some segments with each instrument's errors divided by its weight.
pub(super) fn loss_of<'s>(sums: impl IntoIterator<Item = &'s SegmentSums>, weights: &[f64]) -> f64 {
    let of_segment = |segment: &SegmentSums| {
        let squares: f64 =
            segment.squared_errors.iter().zip(weights).map(|(squared, weight)| squared / (weight * weight)).sum();
        squares + segment.prior_loss
    };
    sums.into_iter().map(of_segment).sum()
}

impl Problem<'_, '_> {
    /// Simulates all segments at `values` from their states in `trial`. If a few segments got worse than before the
    /// step, their states are found again. `before` holds the segments and their sums before the step, those of the
    /// priors last. Returns `None` if the loss grows.
    pub fn tried(
        &self,
        values: &[f64],
        mut trial: Vec<Segment>,
        before: (&[Segment], &[SegmentSums]),
        weights: &[f64],
    ) -> Option<Reached> {
        let (segments_before, sums_before) = before;
        let (sums_before, priors_before) = sums_before.split_at(segments_before.len());
        let losses_before: Vec<f64> = sums_before.iter().map(|sums| loss_of([sums], weights)).collect();
        let prior_loss = self.priors.loss(values);
        let prior_growth = prior_loss - loss_of(priors_before, weights);
        let own_loss = |raw: &RawSums| loss_of(&self.weighed(std::slice::from_ref(raw), weights), weights);
        let simulated = self.each_at(values, &trial);
        let mut raw: Vec<Option<RawSums>> = simulated.into_iter().map(Result::ok).collect();
        let loss_or_infinite =
            |raw: &Option<RawSums>| raw.as_ref().map(own_loss).filter(|loss| loss.is_finite()).unwrap_or(f64::INFINITY);
        let mut losses: Vec<f64> = raw.iter().map(loss_or_infinite).collect();
        let mended: Vec<(usize, Option<(Segment, RawSums)>)> = astray(&losses, &losses_before, prior_growth)?
            .into_par_iter()
            .map(|number| (number, self.segment_refit(values, number, &segments_before[number], weights)))
            .collect();
        for (number, mended) in mended {
            let Some((segment, sums)) = mended else { continue };
            let loss = own_loss(&sums);
            if loss < losses[number] {
                (trial[number], raw[number], losses[number]) = (segment, Some(sums), loss);
            }
        }
        let loss: f64 = losses.iter().sum();
        if loss + prior_growth > losses_before.iter().sum() {
            return None;
        }
        Some(Reached { segments: trial, raw: raw.into_iter().collect::<Option<_>>()?, loss: loss + prior_loss })
    }

    /// Finds the initial state of one segment that fits best at these parameter values, starting from `start`. Returns
    /// it with the sums there.
    fn segment_refit(
        &self,
        values: &[f64],
        number: usize,
        start: &Segment,
        weights: &[f64],
    ) -> Option<(Segment, RawSums)> {
        let at = |segment: &Segment| {
            let raw = self.sums_of(values, number, segment, false).ok()?;
            let sums = self.weighed(std::slice::from_ref(&raw), weights).pop()?;
            let loss = loss_of([&sums], weights);
            loss.is_finite().then_some((sums, loss))
        };
        let mut best = start.clone();
        let (mut sums, mut loss) = at(&best)?;
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let mut next = best.clone();
            let step = sums.state_step(&DVector::zeros(0), damping);
            for (value, change) in next.state.iter_mut().zip(step.iter()) {
                *value += change;
            }
            match at(&next) {
                Some((next_sums, next_loss)) if next_loss <= loss => {
                    let is_last = loss - next_loss < LEAST_IMPROVEMENT * loss;
                    (best, sums, loss) = (next, next_sums, next_loss);
                    damping /= 10.0;
                    if is_last {
                        break;
                    }
                }
                _ => damping *= 10.0,
            }
        }
        let raw = self.sums_of(values, number, &best, true).ok()?;
        Some((best, raw))
    }
}

/// The segments whose losses have grown most: the fewest whose removal keeps the total from growing. Returns `None` if
/// there are too many of them, and an empty list if the total has not grown. `further` is the growth of the loss
/// elsewhere.
fn astray(losses: &[f64], before: &[f64], further: f64) -> Option<Vec<usize>> {
    let growth = |&number: &usize| losses[number] - before[number];
    let mut worst: Vec<usize> = (0..losses.len()).collect();
    worst.sort_by(|a, b| growth(b).total_cmp(&growth(a)));
    let most = (MOST_ASTRAY * losses.len() as f64).floor().max(1.0) as usize;
    let count =
        (0..=most.min(worst.len())).find(|&count| worst[count..].iter().map(growth).sum::<f64>() + further <= 0.0)?;
    worst.truncate(count);
    Some(worst)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use excavator_model::document::built_in;
    use excavator_model::equations::System;
    use excavator_model::recording::Recording;
    use excavator_model::simulation::{Tolerances, simulate_from_rest};

    use super::*;
    use crate::fit::FitSettings;

    #[test]
    fn as_few_segments_are_mended_as_let_the_sum_fall() {
        let before = [1.0; 8];
        let with = |changes: &[(usize, f64)]| {
            let mut losses = before;
            changes.iter().for_each(|&(number, loss)| losses[number] = loss);
            astray(&losses, &before, 0.0)
        };
        assert_eq!(with(&[(0, 0.5), (1, 1.4)]), Some(vec![]), "the sum falls");
        assert_eq!(with(&[(0, 0.5), (1, 1.4), (2, 9.0)]), Some(vec![2]));
        assert_eq!(with(&[(0, 0.5), (1, f64::INFINITY), (2, 9.0)]), Some(vec![1, 2]));
        assert_eq!(with(&[(0, 5.0), (1, f64::INFINITY), (2, 9.0)]), None, "three of eight");
        assert_eq!(with(&[(0, 1.5)]), Some(vec![0]));
        assert_eq!(astray(&[2.0], &[1.0], 0.0), Some(vec![0]), "of a single segment too");
    }

    #[test]
    fn a_segment_that_went_astray_does_not_have_the_step_of_the_others_refused() {
        let model = built_in("zx30u-arm").unwrap();
        let time: Vec<f64> = (0..2000).map(|index| f64::from(index) * 4e-3).collect();
        let mut recording = Recording::unmeasured("swing", time, &["arm"]);
        recording.tank_pressure.fill(3e5);
        recording.pump_flow.fill(3.8e-4);
        recording.cylinders[0].orifice_area = recording.time.iter().map(|t| 4e-5 * (3.1 * t).sin()).collect();
        let recording = simulate_from_rest(&model, &recording, &[0.1], Tolerances::default()).unwrap();
        let system = System::new(&model);
        let settings = FitSettings { segment_duration: 1.0, ..Default::default() };
        let problem = Problem::new(&model, &system, &[&recording], &settings, model.unknown_parameters()).unwrap();
        let segments = problem.segments.clone();
        assert_eq!(segments.len(), 8);
        let right = model.parameter_values();
        let mut off = right.clone();
        problem.fitted.iter().for_each(|&index| off[index] *= 1.05);
        let weights = problem.noise.clone();
        let before = problem.weighed(&problem.sums_at(&off, &segments).unwrap(), &weights);
        let allowed = loss_of(&before, &weights);

        // A step to the right values, but in one segment the cap side pressure starts a hundred bar too high.
        let cap = system.layout().cap_pressure(0).unwrap();
        let mut trial = segments.clone();
        trial[1].state[cap] += 1e7;
        let plain = problem.weighed(&problem.sums_at(&right, &trial).unwrap(), &weights);
        assert!(loss_of(&plain, &weights) > allowed, "refused as it is");
        let reached = problem.tried(&right, trial.clone(), (&segments, &before), &weights).unwrap();
        assert!(reached.loss < 0.1 * allowed, "{} {allowed}", reached.loss);
        assert!((reached.segments[1].state[cap] - segments[1].state[cap]).abs() < 1e5);
        assert_eq!(reached.segments[0], trial[0], "the others are where the step put them");

        // With this error in all segments the step itself is rejected.
        trial.iter_mut().for_each(|segment| segment.state[cap] += 1e7);
        assert!(problem.tried(&right, trial, (&segments, &before), &weights).is_none());
    }
}
