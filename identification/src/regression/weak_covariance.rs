//! How far the parameters of a weak-form regression are spread by noise that is correlated in time.

use nalgebra::{DMatrix, DVector};

use super::weak_rows::Row;

/// Length of the stretches that are left out in turn, s: twice as long as errors of the spool estimate last, and short
/// enough for a recording of half a minute to have many.
const STRETCH: f64 = 1.0;

/// Covariance of the step `-(Z' A)^-1 Z' r` by leaving out one stretch of the recordings after another (delete-a-group
/// jackknife, the CR3 estimate of Bell and McCaffrey 2002), for instruments Z, regressors A and residuals `remaining`
/// after the step.
///
/// Right where noise is coloured and of unequal size, and where few transients carry most of what is known about a
/// parameter (a bulk modulus shows in the moments when a valve opens): estimates that multiply residuals as they are
/// (Newey and West) come out too small there, because the fit has bent to just these rows.
pub(super) fn jackknife_covariance(
    rows: &[Row],
    instruments: &DMatrix<f64>,
    regressors: &DMatrix<f64>,
    remaining: &DVector<f64>,
) -> DMatrix<f64> {
    let order = regressors.ncols();
    let matrix = instruments.transpose() * regressors;
    let mut covariance = DMatrix::zeros(order, order);
    let mut stretches = 0.0;
    let mut first = 0;
    for end in 1..=rows.len() {
        let same = |row: &Row| {
            let start = rows[first].centre;
            row.recording == rows[first].recording && row.centre - start < STRETCH
        };
        if end < rows.len() && same(&rows[end]) {
            continue;
        }
        let own_instruments = instruments.rows(first, end - first);
        let score = own_instruments.transpose() * remaining.rows(first, end - first);
        let without = &matrix - own_instruments.transpose() * regressors.rows(first, end - first);
        // What cannot be told without a stretch is not made up: such a parameter's spread is infinite.
        let shift = without.lu().solve(&score).unwrap_or_else(|| DVector::from_element(order, f64::INFINITY));
        covariance += &shift * shift.transpose();
        stretches += 1.0;
        first = end;
    }
    covariance * ((stretches - 1.0) / stretches)
}
