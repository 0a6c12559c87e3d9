//! A curve through knots: monotone cubic interpolation (Fritsch and Carlson 1980).

use crate::scalar::Scalar;

/// A curve through knots that is monotone between them. Outside the knots it keeps the end values.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Table {
    knots: Vec<f64>,
    values: Vec<f64>,
    slopes: Vec<f64>,
}

impl Table {
    /// Curve through `values` at `knots`; there are at least two knots, in ascending order.
    pub fn new(knots: Vec<f64>, values: Vec<f64>) -> Self {
        let chords: Vec<f64> = (1..knots.len())
            .map(|index| (values[index] - values[index - 1]) / (knots[index] - knots[index - 1]))
            .collect();
        // At each end the curve has the slope of the end chord: two knots give a straight line.
        let mut slopes = vec![0.0; knots.len()];
        if let (Some(&first), Some(&last)) = (chords.first(), chords.last()) {
            slopes[0] = first;
            slopes[knots.len() - 1] = last;
        }
        for index in 1..chords.len() {
            let (before, after) = (chords[index - 1], chords[index]);
            if before * after > 0.0 {
                let (left, right) = (knots[index] - knots[index - 1], knots[index + 1] - knots[index]);
                let weights = (2.0 * right + left, right + 2.0 * left);
                // Weighted harmonic mean of the chords' slopes (Fritsch and Butland 1984): at most three times the
                // smaller one.
                slopes[index] = (weights.0 + weights.1) / (weights.0 / before + weights.1 / after);
            }
        }
        Table { knots, values, slopes }
    }

    /// The curve at `x`.
    pub fn at<T: Scalar>(&self, x: T) -> T {
        let last = self.knots.len() - 1;
        let position = x.value();
        if position.is_nan() {
            return x;
        }
        if position <= self.knots[0] {
            return T::from(self.values[0]);
        }
        if position >= self.knots[last] {
            return T::from(self.values[last]);
        }
        let index = self.knots.partition_point(|&knot| knot <= position) - 1;
        let width = self.knots[index + 1] - self.knots[index];
        let along = (x - self.knots[index]) / width;
        let (from, to) = (self.values[index], self.values[index + 1]);
        let (start, end) = (self.slopes[index] * width, self.slopes[index + 1] * width);
        // Hermite form, in powers of the fraction of the interval.
        let cubic = 2.0 * (from - to) + start + end;
        let square = 3.0 * (to - from) - 2.0 * start - end;
        ((along * cubic + square) * along + start) * along + from
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::{derivative, variable};

    #[test]
    fn a_curve_meets_its_knots_and_keeps_its_direction() {
        let (knots, values) = (vec![0.0, 1.0, 1.5, 4.0, 5.0], vec![0.0, 2.0, 2.0, 3.0, -1.0]);
        let table = Table::new(knots.clone(), values.clone());
        for (knot, value) in knots.iter().zip(&values) {
            assert!((table.at(*knot) - value).abs() < 1e-12);
        }
        assert_eq!((table.at(-1.0), table.at(9.0)), (0.0, -1.0));
        let steps: Vec<f64> = (0..=500).map(|step| table.at(0.01 * f64::from(step))).collect();
        assert!(steps[..100].windows(2).all(|pair| pair[1] >= pair[0]));
        assert!(steps[100..150].iter().all(|value| (value - 2.0).abs() < 1e-12));
        assert!(steps[400..].windows(2).all(|pair| pair[1] <= pair[0]));
    }

    #[test]
    fn its_slope_is_that_of_its_differences() {
        let table = Table::new(vec![-2.0, 0.0, 1.0, 3.0], vec![1.0, 0.0, 4.0, 5.0]);
        for x in [-3.0, -1.9, -0.5, 0.2, 0.99, 2.0, 3.5] {
            let difference = (table.at(x + 1e-6) - table.at(x - 1e-6)) / 2e-6;
            assert!((derivative(&table.at(variable(x, 0)), 0) - difference).abs() < 1e-6, "{x}");
        }
    }
}
