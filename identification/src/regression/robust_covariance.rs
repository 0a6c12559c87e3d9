//! Covariance of least-squares coefficients whose residuals are correlated over time.

use nalgebra::{DMatrix, DVector};

/// `B (sum over lags of w_l G_l) B`, with B the inverse of `X' X` and G_l the sum of `g_t g_(t-l)'` over the scores: Newey and
/// West 1987, with weights that fall linearly to zero at `lags`. It holds for residuals that are correlated over less time than
/// that and differ in size, and tends to the ordinary covariance where neither is so.
///
/// `scores` has one row for each moment: the sum of regressors times residual over the equations of the moment. A moment with the
/// next one missing (`follows` is false) starts a new stretch.
pub(super) fn newey_west(scores: &DMatrix<f64>, follows: &[bool], inverse: &DMatrix<f64>, lags: usize) -> DMatrix<f64> {
    let (moments, coefficients) = scores.shape();
    let mut middle = DMatrix::<f64>::zeros(coefficients, coefficients);
    let mut first = 0;
    while first < moments {
        let last = (first + 1..moments).find(|&moment| !follows[moment]).unwrap_or(moments);
        // Two moments a lag apart are in `lags + 1 - lag` of all windows of this length: their sums give the weights.
        let mut sums = vec![DVector::<f64>::zeros(coefficients)];
        for moment in first..last {
            sums.push(&sums[moment - first] + scores.row(moment).transpose());
        }
        for end in 1..=last - first + lags {
            let window = &sums[end.min(last - first)] - &sums[end.saturating_sub(lags + 1)];
            middle.ger(1.0 / (lags as f64 + 1.0), &window, &window, 1.0);
        }
        first = last;
    }
    inverse * middle * inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A mean of residuals that are the same for four samples at a time has the variance of a quarter as many. The weights take
    /// a little of it: `1 + 2 (40/41 * 3/4 + 39/41 * 2/4 + 38/41 * 1/4)`. One draw of 1000 levels scatters by a tenth.
    #[test]
    fn correlated_residuals_widen_the_variance_of_a_mean() {
        const DRAWS: u64 = 25;
        let (blocks, lags) = (1000, 40);
        let count = 4 * blocks;
        let inverse = DMatrix::from_element(1, 1, 1.0 / count as f64);
        let mut ratio = 0.0;
        for seed in 0..DRAWS {
            let mut random = ChaCha8Rng::seed_from_u64(seed);
            let levels: Vec<f64> = (0..blocks).map(|_| random.random_range(-0.5..0.5)).collect();
            let scores = DMatrix::from_fn(count, 1, |row, _| levels[row / 4]);
            let white = newey_west(&scores, &vec![true; count], &inverse, 0)[(0, 0)];
            let robust = newey_west(&scores, &vec![true; count], &inverse, lags)[(0, 0)];
            assert!((white * count as f64 * 12.0 - 1.0).abs() < 0.15, "{white}");
            ratio += robust / white / DRAWS as f64;
        }
        let wanted = 1.0 + 2.0 * (40.0 * 0.75 + 39.0 * 0.5 + 38.0 * 0.25) / 41.0;
        assert!((ratio / wanted - 1.0).abs() < 0.1, "{ratio} for {wanted}");
    }

    /// Sums over windows are the weighted sum over lags that defines the estimate.
    #[test]
    fn windows_sum_to_the_weighted_lags() {
        let (count, lags) = (60, 7);
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let scores = DMatrix::from_fn(count, 2, |_, _| random.random_range(-1.0..1.0));
        let mut wanted = scores.transpose() * &scores;
        for lag in 1..=lags {
            let later = scores.rows(lag, count - lag).into_owned();
            let product = later.transpose() * scores.rows(0, count - lag);
            wanted += (&product + product.transpose()) * (1.0 - lag as f64 / (lags as f64 + 1.0));
        }
        let found = newey_west(&scores, &vec![true; count], &DMatrix::identity(2, 2), lags);
        assert!((&found - &wanted).amax() < 1e-12 * wanted.amax(), "{found} for {wanted}");
    }

    #[test]
    fn stretches_apart_are_independent() {
        let scores = DMatrix::from_column_slice(4, 1, &[1.0, 1.0, 1.0, 1.0]);
        let one = DMatrix::from_element(1, 1, 1.0);
        let together = newey_west(&scores, &[true; 4], &one, 1)[(0, 0)];
        let apart = newey_west(&scores, &[true, true, false, true], &one, 1)[(0, 0)];
        // 4 + 2 * 3 / 2, and 4 + 2 * 2 / 2.
        assert!((together - 7.0).abs() < 1e-12 && (apart - 6.0).abs() < 1e-12, "{together} {apart}");
    }
}
