//! One step of the parameters: its size, its bounds, and the loss by which it is judged.

use std::sync::Arc;

use excavator_model::Model;
use excavator_model::effects::ParameterCard;
use nalgebra::{DMatrix, DVector};

use super::normal_equations::{RawSums, SegmentSums};

/// Loss of a model whose instruments have these errors; see [`Fit::loss`].
pub(super) fn loss_per_reading(errors: &[f64], noise: &[f64]) -> f64 {
    errors.iter().zip(noise).map(|(error, noise)| 2.0 * (error / noise).max(1e-3).ln()).sum::<f64>()
        / noise.len() as f64
}

/// Root mean square error of each instrument over all segments, not below its noise.
pub(super) fn error_sizes(sums: &[RawSums], noise: &[f64]) -> Vec<f64> {
    noise
        .iter()
        .enumerate()
        .map(|(number, noise)| {
            let squares: f64 = sums.iter().map(|segment| segment.squared_errors()[number]).sum();
            let count: usize = sums.iter().map(|segment| segment.counts()[number]).sum();
            (squares / count.max(1) as f64).sqrt().max(*noise)
        })
        .collect()
}

/// Fitted parameters at a bound that the next step would cross. They are held in that step.
pub(super) fn held_at_bounds(sums: &[SegmentSums], values: &[f64], fitted: &[usize], bounds: &[[f64; 2]]) -> Vec<bool> {
    fitted
        .iter()
        .enumerate()
        .map(|(number, &index)| {
            let downhill: f64 = sums.iter().map(|segment| segment.gradient[number]).sum();
            let [lowest, highest] = bounds[index];
            (values[index] <= lowest && downhill < 0.0) || (values[index] >= highest && downhill > 0.0)
        })
        .collect()
}

pub(super) fn parameter_step(sums: &[SegmentSums], held: &[bool], damping: f64) -> Option<DVector<f64>> {
    let fitted = held.len();
    if fitted == 0 {
        return Some(DVector::zeros(0));
    }
    let mut information = DMatrix::zeros(fitted, fitted);
    let mut gradient = DVector::zeros(fitted);
    for segment in sums {
        information += &segment.information;
        gradient += &segment.gradient;
    }
    let largest = information.diagonal().max();
    for (index, &held) in held.iter().enumerate() {
        if held {
            information.row_mut(index).fill(0.0);
            information.column_mut(index).fill(0.0);
            information[(index, index)] = largest;
            gradient[index] = 0.0;
        }
        // The floor keeps parameters that the recording does not show at their values.
        information[(index, index)] += damping * information[(index, index)] + 1e-12 * largest;
    }
    information.cholesky().map(|factor| factor.solve(&gradient))
}

/// Largest step of the edges of a time window, s. The recordings show an edge only near its present position, so it has
/// to move step by step. A long step ends outside the recording, and nothing leads back from there.
pub(super) const LONGEST_SHIFT: f64 = 1.0;

/// All values after a step of the fitted ones, which stay within their bounds, and the step that was actually taken, in
/// scales.
pub(super) fn bounded_step(
    values: &[f64],
    step: &DVector<f64>,
    fitted: &[usize],
    scales: &[f64],
    cards: &[Arc<ParameterCard>],
    bounds: &[[f64; 2]],
    longest_shift: f64,
) -> (Vec<f64>, DVector<f64>) {
    let mut stepped = values.to_vec();
    let mut taken = DVector::zeros(fitted.len());
    for (number, &index) in fitted.iter().enumerate() {
        let card = &cards[index];
        let most = if card.start.is_a_time() { longest_shift } else { f64::INFINITY };
        let wanted = values[index] + (step[number] * scales[number]).clamp(-most, most);
        let [lowest, highest] = bounds[index];
        stepped[index] = wanted.clamp(lowest, highest);
        taken[number] = (stepped[index] - values[index]) / scales[number];
    }
    (stepped, taken)
}

/// Scale of each of these parameters, in its unit: its magnitude, or the typical value if it is zero.
pub(crate) fn scales(model: &Model, parameters: &[usize]) -> Vec<f64> {
    let all: Vec<(f64, f64)> = model.parameters().map(|(_, one)| (one.value.abs(), one.card.typical.abs())).collect();
    parameters
        .iter()
        .map(|&index| {
            let (value, typical) = all[index];
            if value != 0.0 { value } else { typical }
        })
        .collect()
}
