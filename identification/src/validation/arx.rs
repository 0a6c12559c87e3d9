//! A linear model without physics, as a baseline: the simplest identification of the same recording.
//!
//! Ljung, *System Identification*, 2nd ed., Section 4.2: `y(t) = a1 y(t-1) + ... + b11 u1(t-1) + ... + c`, by least squares, then
//! simulated from its first measured outputs with the inputs alone.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

/// Orders that are tried. The fourth has two resonances, as an arm with its pump line.
const ORDERS: [usize; 4] = [1, 2, 3, 4];
/// Weight on the magnitude of the scaled coefficients. It keeps nearly equal columns from cancelling each other.
const RIDGE: f64 = 1e-9;

/// Outputs of the ARX model that fits `output` best when it is simulated with `inputs`, piece by piece. All signals
/// have the same length. Returns `None` if no model of these orders can be determined.
pub(super) fn simulated_arx(output: &[f64], inputs: &[Vec<f64>], pieces: &[Range<usize>]) -> Option<Vec<f64>> {
    let (offset, scale) = offset_and_scale(output)?;
    let scaled = |values: &[f64], offset: f64, scale: f64| -> Vec<f64> {
        values.iter().map(|value| (value - offset) / scale).collect()
    };
    let own = scaled(output, offset, scale);
    let driving: Vec<Vec<f64>> = inputs
        .iter()
        .filter_map(|input| offset_and_scale(input).map(|(offset, scale)| scaled(input, offset, scale)))
        .collect();
    let error = |simulated: &[f64]| -> f64 {
        own.iter().zip(simulated).map(|(own, simulated)| (own - simulated).powi(2)).filter(|e| !e.is_nan()).sum()
    };
    let models = ORDERS.iter().filter_map(|&order| Arx::fitted(&own, &driving, pieces, order));
    let simulations =
        models.map(|model| model.simulated(&own, &driving, pieces)).map(|values| (error(&values), values));
    let (_, nearest) = simulations.filter(|(error, _)| error.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some(nearest.into_iter().map(|value| offset + scale * value).collect())
}

/// Mean and standard deviation; `None` for a signal with holes or one that never changes.
fn offset_and_scale(values: &[f64]) -> Option<(f64, f64)> {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    (variance.is_finite() && variance > 0.0).then(|| (mean, variance.sqrt()))
}

struct Arx {
    order: usize,
    /// Coefficients of previous outputs, latest first, then of previous values of each input, latest first, then the
    /// constant.
    coefficients: DVector<f64>,
}

impl Arx {
    fn fitted(output: &[f64], inputs: &[Vec<f64>], pieces: &[Range<usize>], order: usize) -> Option<Arx> {
        let columns = order * (1 + inputs.len()) + 1;
        let (mut matrix, mut right) = (DMatrix::zeros(columns, columns), DVector::zeros(columns));
        let mut rows = 0;
        for piece in pieces {
            for now in piece.start + order..piece.end {
                let row = row(output, inputs, order, now);
                matrix.ger(1.0, &row, &row, 1.0);
                right.axpy(output[now], &row, 1.0);
                rows += 1;
            }
        }
        if rows < 2 * columns {
            return None;
        }
        let ridge = RIDGE * rows as f64;
        (0..columns).for_each(|index| matrix[(index, index)] += ridge);
        let coefficients = matrix.cholesky()?.solve(&right);
        Some(Arx { order, coefficients })
    }

    /// Simulates from the first measured outputs of each piece.
    fn simulated(&self, output: &[f64], inputs: &[Vec<f64>], pieces: &[Range<usize>]) -> Vec<f64> {
        let mut simulated = output.to_vec();
        for piece in pieces {
            for now in piece.start + self.order..piece.end {
                simulated[now] = self.coefficients.dot(&row(&simulated, inputs, self.order, now));
            }
        }
        simulated
    }
}

fn row(output: &[f64], inputs: &[Vec<f64>], order: usize, now: usize) -> DVector<f64> {
    let before = |values: &[f64]| (1..=order).map(|lag| values[now - lag]).collect::<Vec<f64>>();
    let all = std::iter::once(before(output)).chain(inputs.iter().map(|input| before(input))).flatten().chain([1.0]);
    DVector::from_iterator(order * (1 + inputs.len()) + 1, all)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_linear_machine_is_reproduced() {
        let input: Vec<f64> = (0..2000).map(|k| f64::from(k * k % 97) / 97.0 + (0.01 * f64::from(k)).sin()).collect();
        let mut output = vec![3.0, 3.1];
        for k in 2..2000 {
            output.push(1.6 * output[k - 1] - 0.7 * output[k - 2] + 0.2 * input[k - 1] + 0.05);
        }
        let whole = simulated_arx(&output, std::slice::from_ref(&input), std::slice::from_ref(&(0..2000))).unwrap();
        let worst = output.iter().zip(&whole).map(|(y, own)| (y - own).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-4, "{worst}");
    }

    #[test]
    fn what_cannot_be_determined_is_none() {
        let piece = 0..10;
        let flat = vec![2.0; 10];
        assert!(simulated_arx(&flat, &[], std::slice::from_ref(&piece)).is_none());
        let short: Vec<f64> = (0..3).map(f64::from).collect();
        assert!(simulated_arx(&short, &[], std::slice::from_ref(&(0..3))).is_none());
        let mut hole: Vec<f64> = (0..10).map(f64::from).collect();
        hole[4] = f64::NAN;
        assert!(simulated_arx(&hole, &[], std::slice::from_ref(&piece)).is_none());
    }
}
