//! How often each candidate would have been named on recordings like these.
//!
//! Moving-block bootstrap (Künsch 1989): stretches of the validation recordings are drawn with replacement, as many as there
//! are, and the candidates judged anew on what was drawn. An effect that is named in nearly all draws is seen all through
//! the recordings; one that is named in half of them hangs on a few moments.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::Candidate;
use crate::fit::Fit;

/// Draws; the standard error of a share is 0.02 at most.
const DRAWS: usize = 500;
/// Half-second blocks that are drawn together, since neighbours are alike.
const TOGETHER: usize = 4;
/// Seed, so that a diagnosis is the same each time.
const SEED: u64 = 1;

/// Shares of the draws.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inclusion {
    /// In which the candidate gains enough to be worth naming.
    pub gains: f64,
    /// In which it gains most of all candidates.
    pub is_first: f64,
}

/// One entry per candidate, for additions to the model that `base_validation` is of. All zero where there are too few
/// blocks to draw from.
pub(super) fn inclusion(base_validation: &Fit, candidates: &[Candidate], least_gain: f64) -> Vec<Inclusion> {
    let mut shares = vec![Inclusion::default(); candidates.len()];
    let blocks = base_validation.block_errors.len();
    if blocks < 2 * TOGETHER || candidates.iter().any(|one| one.validation.block_errors.len() != blocks) {
        return shares;
    }
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    for _ in 0..DRAWS {
        let drawn: Vec<usize> = (0..blocks.div_ceil(TOGETHER))
            .flat_map(|_| {
                let first = random.random_range(0..=blocks - TOGETHER);
                first..first + TOGETHER
            })
            .collect();
        let base = base_validation.loss_on(&drawn);
        let gains: Vec<f64> = candidates.iter().map(|one| base - one.validation.loss_on(&drawn)).collect();
        let best = gains.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for (share, gain) in shares.iter_mut().zip(gains) {
            share.gains += f64::from(u8::from(gain >= least_gain)) / DRAWS as f64;
            share.is_first += f64::from(u8::from(gain == best)) / DRAWS as f64;
        }
    }
    shares
}
