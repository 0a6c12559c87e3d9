//! Covariance of fitted parameters, from the normal equations and the scatter of their blocks.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::normal_equations::SegmentSums;

/// Share of the largest eigenvalue of the information, in units where its diagonal is 1, below which recordings say nothing of
/// a direction: rounding in sums of 1e4 samples leaves 1e-14 of what cancels.
const NOTHING_SAID: f64 = 1e-12;
/// Part that a parameter may have in such a direction and still be called determined.
const NO_PART: f64 = 1e-3;

/// Covariance that holds for coloured errors: blocks of half a second are taken as independent, errors inside one may be
/// correlated in any way (cluster-robust "sandwich", Liang and Zeger 1986), with the factor n/(n - p) on the blocks. And the
/// ratio of its diagonal to that of white errors.
///
/// A recording with no more blocks than parameters cannot tell for each of them how far its errors are from white. They then share one
/// ratio, the mean over all directions.
///
/// `scales` are the units of the parameters in `sums`. A parameter of which the recordings say nothing, alone or against
/// another, has an infinite variance and an inflation of NaN; it takes nothing from what is known of the others.
pub(super) fn clustered_covariance(sums: &[SegmentSums], scales: &[f64]) -> (DMatrix<f64>, Vec<f64>) {
    let fitted = scales.len();
    let information = sums.iter().fold(DMatrix::zeros(fitted, fitted), |sum, segment| sum + &segment.information);
    of_blocks(information, sums.iter().flat_map(|segment| &segment.block_gradients), scales)
}

/// The same from J' J and the gradient J' r of each block.
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
        // In units of white errors: the trace of I^-1 M has one part for each direction, and blocks add up to zero at an optimum.
        let mean = (&inverse * meat).trace() / parameters * (blocks / (blocks - 1.0).max(1.0));
        // Two blocks cancel each other, whatever they say.
        &inverse * if blocks > 2.0 { mean.max(1.0) } else { f64::INFINITY }
    };
    // White-noise theory is a lower bound that few clusters can fall below by chance.
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

/// Inverse of the information, and the parameters of which it says nothing; the inverse is then that of the directions of
/// which something is known.
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

    /// Information of two parameters that are known, and of the third and fourth only their sum; of the fifth nothing.
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

    /// Errors whose variance is four times what white noise would have, in fewer blocks than there are parameters.
    #[test]
    fn a_short_recording_has_one_inflation_for_all() {
        let information = DMatrix::<f64>::from_diagonal(&DVector::from_vec(vec![4.0, 9.0, 1.0, 16.0]));
        // Blocks that add up to zero, each direction with four times its white share.
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
