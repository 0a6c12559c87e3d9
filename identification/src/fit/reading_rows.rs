//! Gathers rows of a Jacobian and multiplies many at a time.

use nalgebra::{DMatrix, DVector};

/// Rows that are multiplied together: enough for fast matrix products, few enough to stay in the cache.
const TOGETHER: usize = 64;

/// Readings of one instrument that are not yet in its normal equations: slopes and error of each, in units of its noise.
#[derive(Debug)]
pub(super) struct ReadingRows {
    /// One row per column of the Jacobian, one column per reading.
    slopes: DMatrix<f64>,
    errors: DVector<f64>,
    filled: usize,
}

impl ReadingRows {
    /// Allocates memory for rows with this many columns.
    pub fn new(columns: usize) -> Self {
        ReadingRows { slopes: DMatrix::zeros(columns, TOGETHER), errors: DVector::zeros(TOGETHER), filled: 0 }
    }

    /// Adds one reading.
    pub fn push(&mut self, slopes: impl Iterator<Item = f64>, error: f64) {
        for (slot, slope) in self.slopes.column_mut(self.filled).iter_mut().zip(slopes) {
            *slot = slope;
        }
        self.errors[self.filled] = error;
        self.filled += 1;
    }

    /// Whether there is no room for another reading.
    pub fn is_full(&self) -> bool {
        self.filled == TOGETHER
    }

    /// Adds J' J and J' r of the gathered readings to the sums, and clears the readings.
    pub fn add_to(&mut self, information: &mut DMatrix<f64>, gradient: &mut DVector<f64>) {
        if self.filled == 0 {
            return;
        }
        let slopes = self.slopes.columns(0, self.filled);
        information.gemm(1.0, &slopes, &slopes.transpose(), 1.0);
        gradient.gemv(1.0, &slopes, &self.errors.rows(0, self.filled), 1.0);
        self.filled = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::{ReadingRows, TOGETHER};
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn sums_are_those_of_single_readings() {
        let (columns, readings) = (7, TOGETHER + 5);
        let slope = |reading: usize, column: usize| ((3 * reading + 5 * column) as f64).sin();
        let error = |reading: usize| (reading as f64).cos();
        let mut wanted = (DMatrix::zeros(columns, columns), DVector::zeros(columns));
        let mut found = wanted.clone();
        let mut rows = ReadingRows::new(columns);
        for reading in 0..readings {
            let row = DVector::from_fn(columns, |column, _| slope(reading, column));
            wanted.0 += &row * row.transpose();
            wanted.1 += &row * error(reading);
            if rows.is_full() {
                rows.add_to(&mut found.0, &mut found.1);
            }
            rows.push(row.iter().copied(), error(reading));
        }
        rows.add_to(&mut found.0, &mut found.1);
        assert!((wanted.0 - found.0).abs().max() < 1e-12);
        assert!((wanted.1 - found.1).abs().max() < 1e-12);
    }
}
