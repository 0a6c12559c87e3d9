//! The one statistic of a verdict: the log error ratio.
//!
//! The errors of a model are sensor noise and, where physics is missing, an additional error that changes with time. So each
//! block of half a second has an error variance of its own, not below that of the noise. With normal errors of that variance,
//! twice the negative log-likelihood per reading, beyond that of noise alone, is
//!
//! ```text
//! c(r) = ln r      for r > 1
//! c(r) = r - 1     for r <= 1,     r = mean squared error of the block / noise variance
//! ```
//!
//! The log error ratio is its mean over the readings of an instrument, then over instruments: 0 is noise alone, 0.7 twice the
//! noise variance in every block. One bad moment in twenty adds a twentieth of its logarithm. Hitting a stop once therefore does
//! not spoil a model, and an effect that acts in one moment of twenty is still visible.

use super::scores::{Block, Hypothesis, Misfit, Scores, Side};

/// c(r), above.
pub fn block_cost(error_ratio: f64) -> f64 {
    if error_ratio > 1.0 { error_ratio.ln() } else { error_ratio - 1.0 }
}

/// Log error ratio of a misfit, against sensor noise alone; 0 where nothing was read.
pub fn log_error_ratio(side: &Side, misfit: &Misfit) -> f64 {
    mean(per_instrument(side, misfit, |_, ratio| block_cost(ratio)))
}

/// The same relative to sensor noise plus the error that the input readings cause, which no model can avoid.
pub fn log_error_ratio_beyond_inputs(side: &Side, misfit: &Misfit) -> f64 {
    mean(per_instrument(side, misfit, |number, ratio| block_cost(ratio / unavoidable(side, number))))
}

/// Unavoidable error variance, over the noise variance.
fn unavoidable(side: &Side, instrument: usize) -> f64 {
    1.0 + side.input_floor.get(instrument).copied().unwrap_or(0.0)
}

/// Share of the blocks in which the mean squared error of any instrument is more than `factor` times its noise variance.
pub fn error_ratio_shares(side: &Side, misfit: &Misfit, factor: f64) -> f64 {
    let is_off = |ratios: &&Vec<f32>| ratios.iter().any(|&ratio| f64::from(ratio) > factor);
    misfit.error_ratios.iter().filter(is_off).count() as f64 / side.blocks.len().max(1) as f64
}

/// Mean squared error beyond the noise, over the signal's own variance, mean over instruments: the share of the machine's
/// behaviour that a model gets wrong.
pub fn relative_error(side: &Side, misfit: &Misfit) -> f64 {
    let of_variance = side.instruments.iter().map(|scale| (scale.noise / scale.spread).powi(2)).collect::<Vec<_>>();
    let ratios = per_instrument(side, misfit, |_, ratio| ratio).zip(seen(side));
    let errors: Vec<f64> = ratios
        .filter(|&(_, number)| side.instruments[number].spread > 0.0)
        .map(|(ratio, number)| (ratio - 1.0).max(0.0) * of_variance[number])
        .collect();
    mean(errors.into_iter())
}

/// The cost of each block beyond the input readings, identification recordings first, then validation recordings.
pub fn block_costs(scores: &Scores, hypothesis: &Hypothesis) -> [Vec<f64>; 2] {
    [
        block_costs_of(&scores.identification, &hypothesis.identification),
        block_costs_of(&scores.validation, &hypothesis.validation),
    ]
}

/// The same for one kind of recordings: mean over the instruments, each weighted by its share of readings in the block, so that
/// the mean over blocks is the log error ratio beyond the input readings.
pub fn block_costs_of(side: &Side, misfit: &Misfit) -> Vec<f64> {
    // Each instrument has the same weight, however often it is read.
    let totals: Vec<f64> = (0..side.instruments.len()).map(|number| readings(&side.blocks, number)).collect();
    let instruments = totals.iter().filter(|total| **total > 0.0).count();
    let scale = side.blocks.len() as f64 / instruments.max(1) as f64;
    let each = side.blocks.iter().zip(&misfit.error_ratios);
    each.map(|(block, ratios)| {
        let cost = |(number, &ratio): (usize, &f32)| {
            let share = block.readings[number] as f64 / totals[number].max(1.0);
            share * block_cost(f64::from(ratio) / unavoidable(side, number))
        };
        scale * ratios.iter().enumerate().map(cost).sum::<f64>()
    })
    .collect()
}

fn seen(side: &Side) -> impl Iterator<Item = usize> {
    (0..side.instruments.len()).filter(|&number| readings(&side.blocks, number) > 0.0)
}

fn readings(blocks: &[Block], instrument: usize) -> f64 {
    blocks.iter().map(|block| block.readings[instrument] as f64).sum()
}

fn per_instrument<'a>(
    side: &'a Side,
    misfit: &'a Misfit,
    of: impl Fn(usize, f64) -> f64 + 'a,
) -> impl Iterator<Item = f64> + 'a {
    seen(side).map(move |number| {
        let blocks = side.blocks.iter().zip(&misfit.error_ratios);
        let sum: f64 =
            blocks.map(|(block, ratios)| block.readings[number] as f64 * of(number, f64::from(ratios[number]))).sum();
        sum / readings(&side.blocks, number)
    })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    if count == 0 { 0.0 } else { sum / f64::from(count) }
}
