//! Spread of the parameters of a weak-form regression under noise that is correlated in time.

use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::weak_rows::Row;

/// Length of the stretches that are left out in turn, s. It is twice the duration of errors of the spool estimate, and
/// short enough for many stretches in half a minute.
pub(super) const STRETCH: f64 = 1.0;

/// Spread of the parameters due to noise.
pub(super) struct Spread {
    pub covariance: DMatrix<f64>,
    /// Half widths of 95 % intervals in standard errors.
    pub quantiles: DVector<f64>,
}

/// Spread of the step `-(Z' A)^-1 Z' r` by leaving out one stretch of the recordings after another (delete-a-group
/// jackknife, the CR3 estimate of Bell and McCaffrey 2002), for instruments Z, regressors A and residuals `remaining`
/// after the step.
///
/// This holds for coloured noise of unequal size, and if few transients carry most of the information about a parameter
/// (a bulk modulus shows in the moments when a valve opens). Estimates from the plain residuals (Newey and West) are
/// too small there, because the fit has adapted to just these rows.
///
/// If a few stretches carry nearly all information, their spread is itself uncertain, so the intervals are those of a t
/// distribution. Its degrees of freedom are the effective number of stretches for white noise (Bell and McCaffrey), or
/// the observed effective number (Satterthwaite) if that is smaller: noise is largest in the very transients that carry
/// most information. With 1.96 standard errors only 80 % of the intervals of a pump line's bulk modulus contained the
/// truth.
pub(super) fn jackknife(
    rows: &[Row],
    instruments: &DMatrix<f64>,
    regressors: &DMatrix<f64>,
    remaining: &DVector<f64>,
    stretch: f64,
) -> Spread {
    let order = regressors.ncols();
    let matrix = instruments.transpose() * regressors;
    let mut covariance = DMatrix::zeros(order, order);
    let mut shares = Shares::new(order);
    let mut stretches = 0.0;
    let mut first = 0;
    for end in 1..=rows.len() {
        let same = |row: &Row| {
            let start = rows[first].centre;
            row.recording == rows[first].recording && row.centre - start < stretch
        };
        if end < rows.len() && same(&rows[end]) {
            continue;
        }
        let own_instruments = instruments.rows(first, end - first);
        let score = own_instruments.transpose() * remaining.rows(first, end - first);
        let without = &matrix - own_instruments.transpose() * regressors.rows(first, end - first);
        // A parameter that is not determined without this stretch gets an infinite spread.
        let without = without.lu();
        let shift = without.solve(&score).unwrap_or_else(|| DVector::from_element(order, f64::INFINITY));
        if let Some(by_row) = without.solve(&own_instruments.transpose()) {
            shares.would_be(&by_row);
        }
        shares.took_place(&shift);
        covariance += &shift * shift.transpose();
        stretches += 1.0;
        first = end;
    }
    Spread { covariance: covariance * ((stretches - 1.0) / stretches), quantiles: shares.quantiles() }
}

/// Contributions of the stretches to the variance of each parameter.
struct Shares {
    /// Sums over stretches of the contribution for white noise, and of its square.
    white: [DVector<f64>; 2],
    /// Sums over stretches of the second and fourth power of the observed shift.
    real: [DVector<f64>; 2],
}

impl Shares {
    fn new(order: usize) -> Self {
        let zeros = || [DVector::zeros(order), DVector::zeros(order)];
        Shares { white: zeros(), real: zeros() }
    }

    /// Adds a stretch that shifts the parameters by `by_row` times the noise of its rows.
    fn would_be(&mut self, by_row: &DMatrix<f64>) {
        for (parameter, row) in by_row.row_iter().enumerate() {
            let share = row.norm_squared();
            self.white[0][parameter] += share;
            self.white[1][parameter] += share * share;
        }
    }

    /// Adds a stretch that shifts the parameters by `shift`.
    fn took_place(&mut self, shift: &DVector<f64>) {
        for (parameter, shift) in shift.iter().enumerate() {
            self.real[0][parameter] += shift.powi(2);
            self.real[1][parameter] += shift.powi(4);
        }
    }

    /// Half widths of 95 % intervals, in standard errors.
    fn quantiles(&self) -> DVector<f64> {
        let quantile = |parameter: usize| {
            let [[sum, squares], [second, fourth]] =
                [&self.white, &self.real].map(|of| of.each_ref().map(|sums| sums[parameter]));
            // The mean fourth power of a normal shift is three times the square of its variance.
            let (white, real) = (sum * sum / squares, 3.0 * second * second / fourth - 2.0);
            // There is at least one degree of freedom. A parameter that no stretch shows is unknown anyway.
            match StudentsT::new(0.0, 1.0, white.min(real).max(1.0)) {
                Ok(distribution) => distribution.inverse_cdf(0.975),
                Err(_) => f64::NAN,
            }
        };
        DVector::from_fn(self.white[0].len(), |parameter, _| quantile(parameter))
    }
}
