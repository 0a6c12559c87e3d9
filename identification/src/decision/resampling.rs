//! Circular block bootstrap (Politis and Romano 1992) of the two kinds of recordings.
//!
//! Errors of neighbouring moments are correlated, so neighbouring half-second blocks are drawn together.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Number of draws; the standard error of a share is 0.02 at most.
pub(super) const DRAWS: usize = 500;

/// Number of half-second blocks drawn together.
const TOGETHER: usize = 4;

/// Fixed seed, so that a verdict is reproducible.
const SEED: u64 = 1;

/// How often each block of each kind of recordings was drawn, for each draw.
pub(super) struct Resampling {
    kinds: Vec<Vec<Vec<f64>>>,
}

/// The mean cost of a hypothesis, overall and in each draw. Both kinds of recordings have the same weight.
#[derive(Debug, Clone)]
pub(super) struct Resampled {
    pub mean: f64,
    pub draws: Vec<f64>,
}

impl Resampling {
    /// For kinds of recordings with these numbers of blocks.
    pub fn new(blocks: &[usize]) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let mut draws = |blocks: usize| (0..DRAWS).map(|_| counts(blocks, &mut random)).collect();
        Resampling { kinds: blocks.iter().map(|&blocks| draws(blocks)).collect() }
    }

    /// Means of one hypothesis from the costs of its blocks, one list per kind of recordings.
    pub fn of(&self, costs: &[Vec<f64>]) -> Resampled {
        let each = || self.kinds.iter().zip(costs);
        let share = 1.0 / self.kinds.len().max(1) as f64;
        Resampled {
            mean: share * each().map(|(_, costs)| mean(costs)).sum::<f64>(),
            draws: (0..DRAWS)
                .map(|draw| share * each().map(|(counts, costs)| weighed(&counts[draw], costs)).sum::<f64>())
                .collect(),
        }
    }
}

impl Resampled {
    /// By how much `other` is better, also in standard errors of that difference; 0 standard errors if both are equal.
    pub fn improvement(&self, other: &Resampled) -> (f64, f64) {
        let difference = self.mean - other.mean;
        let spread = spread(&self.draws.iter().zip(&other.draws).map(|(a, b)| a - b).collect::<Vec<_>>());
        (difference, if spread > 0.0 { difference / spread } else { 0.0 })
    }
}

/// Standard deviation of some values.
pub(super) fn spread(values: &[f64]) -> f64 {
    let middle = mean(values);
    (values.iter().map(|value| (value - middle).powi(2)).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// By how much a second hypothesis is better than a first, from their costs on the same blocks, also in standard errors of that
/// difference.
pub fn improvement_on_blocks(first: Vec<f64>, second: Vec<f64>) -> (f64, f64) {
    let resampling = Resampling::new(&[first.len().min(second.len())]);
    resampling.of(&[first]).improvement(&resampling.of(&[second]))
}

fn counts(blocks: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    let mut counts = vec![0.0; blocks];
    if blocks == 0 {
        return counts;
    }
    for _ in 0..blocks.div_ceil(TOGETHER) {
        let first = random.random_range(0..blocks);
        for next in 0..TOGETHER.min(blocks) {
            counts[(first + next) % blocks] += 1.0;
        }
    }
    counts
}

fn weighed(counts: &[f64], costs: &[f64]) -> f64 {
    let (sum, count) =
        counts.iter().zip(costs).fold((0.0, 0.0), |(sum, total), (count, cost)| (sum + count * cost, total + count));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// Mean of some values; 0 for an empty slice.
pub(super) fn mean(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.iter().sum::<f64>() / values.len() as f64 }
}
