//! Covariance of fitted parameters, from the normal equations and the scatter of their blocks.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::normal_equations::SegmentSums;

/// Threshold relative to the largest eigenvalue of the information matrix (scaled to a unit diagonal). The recordings
/// do not determine a direction whose eigenvalue is below it. Rounding in sums of 1e4 samples leaves 1e-14 of terms
/// that cancel.
const NOTHING_SAID: f64 = 1e-12;
/// Largest component of a parameter along such a direction at which the parameter still counts as determined.
const NO_PART: f64 = 1e-3;

/// Covariance for coloured errors, and the ratio of its diagonal to that for white errors. Blocks of half a second are
/// taken as independent. Errors inside one block may be correlated in any way (cluster-robust "sandwich", Liang and
/// Zeger 1986), with the factor n/(n - p) on the blocks.
///
/// If there are no more blocks than parameters, the deviation from white errors cannot be estimated per parameter. All
/// parameters then share one ratio, the mean over all directions.
///
/// `scales` are the units of the parameters in `sums`. A parameter that the recordings do not determine, alone or in a
/// combination, has an infinite variance and an inflation of NaN. It does not affect the other parameters.
pub(super) fn clustered_covariance(sums: &[SegmentSums], scales: &[f64]) -> (DMatrix<f64>, Vec<f64>) {
    let fitted = scales.len();
    let information = sums.iter().fold(DMatrix::zeros(fitted, fitted), |sum, segment| sum + &segment.information);
    of_blocks(information, sums.iter().flat_map(|segment| &segment.block_gradients), scales)
}

/// The same computation from J' J and the gradient J' r of each block.
fn of_blocks<'b>(
    information: DMatrix<f64>,
    gradients: impl Iterator<Item = &'b DVector<f64>>,
    scales: &[f64],
) -> (DMatrix<f64>, Vec<f64>) {
    let fitted = scales.len();
    let mut meat = DMatrix::<f64>::zeros(fitted, fitted);
    let mut blocks = 0.0;
    for block in gradients {
        meat += block * block.transpose();
        blocks += 1.0;
    }
    let (inverse, undetermined) = inverse(information);
    let parameters = fitted as f64;
    let mut covariance = if blocks > parameters {
        &inverse * meat * &inverse * (blocks / (blocks - parameters))
    } else {
        // In units of white errors: each direction adds one term to the trace of I^-1 M, and block gradients sum to
        // zero at an optimum.
        let mean = (&inverse * meat).trace() / parameters * (blocks / (blocks - 1.0).max(1.0));
        // The gradients of two blocks always cancel.
        &inverse * if blocks > 2.0 { mean.max(1.0) } else { f64::INFINITY }
    };
    // White-noise theory is a lower bound. With few clusters the estimate can fall below it by chance.
    for index in 0..fitted {
        covariance[(index, index)] = covariance[(index, index)].max(inverse[(index, index)]);
    }
    let mut inflation: Vec<f64> =
        (0..fitted).map(|index| covariance[(index, index)] / inverse[(index, index)]).collect();
    for row in 0..fitted {
        for column in 0..fitted {
            covariance[(row, column)] *= scales[row] * scales[column];
        }
    }
    for index in undetermined {
        covariance.row_mut(index).fill(0.0);
        covariance.column_mut(index).fill(0.0);
        covariance[(index, index)] = f64::INFINITY;
        inflation[index] = f64::NAN;
    }
    (covariance, inflation)
}

/// Inverse of the information matrix, and the parameters that it does not determine. If there are any, the inverse
/// covers the determined directions only.
fn inverse(information: DMatrix<f64>) -> (DMatrix<f64>, Vec<usize>) {
    if let Some(factor) = information.clone().cholesky() {
        return (factor.inverse(), Vec::new());
    }
    let fitted = information.nrows();
    let scale = information.diagonal().map(|own| if own > 0.0 { own.sqrt().recip() } else { 0.0 });
    let scaled =
        DMatrix::from_fn(fitted, fitted, |row, column| scale[row] * information[(row, column)] * scale[column]);
    if scaled.iter().any(|value| !value.is_finite()) {
        return (DMatrix::zeros(fitted, fitted), (0..fitted).collect());
    }
    let eigen = SymmetricEigen::new(scaled);
    let least = NOTHING_SAID * eigen.eigenvalues.amax();
    let said = |number: usize| eigen.eigenvalues[number] > least;
    let known =
        DVector::from_fn(fitted, |number, _| if said(number) { eigen.eigenvalues[number].recip() } else { 0.0 });
    let scaled = &eigen.eigenvectors * DMatrix::from_diagonal(&known) * eigen.eigenvectors.transpose();
    let inverse = DMatrix::from_fn(fitted, fitted, |row, column| scale[row] * scaled[(row, column)] * scale[column]);
    let has_part =
        |index: usize| (0..fitted).any(|number| !said(number) && eigen.eigenvectors[(index, number)].abs() > NO_PART);
    (inverse, (0..fitted).filter(|&index| has_part(index)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Information matrix that determines the first two parameters, only the sum of the third and fourth, and not the
    /// fifth.
    fn information() -> DMatrix<f64> {
        let mut information = DMatrix::zeros(5, 5);
        information.view_mut((0, 0), (2, 2)).copy_from(&DMatrix::from_row_slice(2, 2, &[4e6, 1e3, 1e3, 1.0]));
        information.view_mut((2, 2), (2, 2)).fill(9.0);
        information
    }

    #[test]
    fn what_nothing_is_said_of_takes_nothing_from_the_others() {
        let (inverse, undetermined) = inverse(information());
        assert_eq!(undetermined, [2, 3, 4]);
        let known = inverse.view((0, 0), (2, 2)) * information().view((0, 0), (2, 2));
        assert!((known - DMatrix::<f64>::identity(2, 2)).amax() < 1e-9);
    }

    /// Errors with four times the variance of white noise, in fewer blocks than there are parameters.
    #[test]
    fn a_short_recording_has_one_inflation_for_all() {
        let information = DMatrix::<f64>::from_diagonal(&DVector::from_vec(vec![4.0, 9.0, 1.0, 16.0]));
        // Block gradients that sum to zero, with four times the white-noise variance in each direction.
        let block = |signs: [f64; 4]| {
            DVector::from_iterator(4, (0..4).map(|row| signs[row] * information[(row, row)].sqrt() * 2.0 / 2.0))
        };
        let blocks = [[1.0, 1.0, 1.0, 1.0], [-1.0, 1.0, -1.0, 1.0], [1.0, -1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, -3.0]];
        let blocks: Vec<DVector<f64>> = blocks.into_iter().map(block).collect();
        let (covariance, inflation) = of_blocks(information.clone(), blocks.iter(), &[1.0; 4]);
        let wanted = (4.0 + 4.0 + 4.0 + 12.0) / 4.0 * 4.0 / 3.0;
        for row in 0..4 {
            assert!((inflation[row] - wanted).abs() < 1e-9, "{inflation:?}");
            assert!((covariance[(row, row)] - wanted / information[(row, row)]).abs() < 1e-9);
        }
        let (two, _) = of_blocks(information, blocks[..2].iter(), &[1.0; 4]);
        assert!(two[(0, 0)].is_infinite());
    }

    #[test]
    fn where_everything_is_determined_it_is_the_inverse() {
        let regular = DMatrix::from_row_slice(2, 2, &[4e6, 1e3, 1e3, 1.0]);
        let (inverse, undetermined) = inverse(regular.clone());
        assert!(undetermined.is_empty());
        assert!((inverse * regular - DMatrix::<f64>::identity(2, 2)).amax() < 1e-9);
    }
}
