//! Is one model better than another on data that neither was fitted to?

use crate::fit::Fit;

/// How much better one model predicts than another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evidence {
    /// Loss of the first minus loss of the second: positive when the second is better.
    pub gain: f64,
    /// The gain's likelihood ratio in standard errors, from block to block (Vuong 1989): correlated errors inside a
    /// block count once.
    pub significance: f64,
}

/// Compares two models on the same recordings. Both must have been evaluated with the same segments and instruments.
pub fn compare_losses(first: &Fit, second: &Fit) -> Evidence {
    let gain = first.loss() - second.loss();
    let differences: Vec<f64> = first
        .block_errors
        .iter()
        .zip(&second.block_errors)
        .map(|(a, b)| block_likelihood(second, b) - block_likelihood(first, a))
        .collect();
    Evidence { gain, significance: significance(&differences) }
}

/// Significance of two gains on different recordings together (Stouffer et al. 1949).
pub(super) fn joint_significance(one: Evidence, other: Evidence) -> f64 {
    (one.significance + other.significance) / std::f64::consts::SQRT_2
}

/// Logarithmic likelihood of a block's errors under normal errors of the size that the model has overall.
fn block_likelihood(fit: &Fit, block: &[(f64, usize)]) -> f64 {
    block
        .iter()
        .zip(fit.errors.iter().zip(&fit.instruments))
        .map(|((squares, count), (error, instrument))| {
            let deviation = error.max(instrument.noise);
            -0.5 * (squares / (deviation * deviation) + *count as f64 * 2.0 * (deviation / instrument.noise).ln())
        })
        .sum()
}

/// Mean over its standard error, with neighbouring blocks allowed to be correlated.
fn significance(differences: &[f64]) -> f64 {
    let count = differences.len() as f64;
    if differences.len() < 4 {
        return 0.0;
    }
    let mean = differences.iter().sum::<f64>() / count;
    let deviations: Vec<f64> = differences.iter().map(|difference| difference - mean).collect();
    let variance: f64 = deviations.iter().map(|d| d * d).sum::<f64>();
    let neighbours: f64 = deviations.windows(2).map(|pair| pair[0] * pair[1]).sum();
    // Bartlett weight 1/2 for the first neighbour on both sides; negative correlation is not allowed to help.
    let long_run = variance + neighbours.max(0.0);
    if long_run > 0.0 { mean * count / long_run.sqrt() } else { 0.0 }
}
