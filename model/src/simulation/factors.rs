//! Solves linear systems of the order of a model's states, in reused memory.
//!
//! A custom solver instead of `nalgebra`, whose matrices of run-time size allocate at each factorisation and use
//! general kernels: for five to a dozen states those cost several times the arithmetic itself.

/// LU factors, with row exchanges, of a small square matrix.
#[derive(Debug, Clone)]
pub(super) struct Factors {
    order: usize,
    /// Row-major: the matrix before [`Factors::factorise`], both triangles after it.
    entries: Vec<f64>,
    inverse_pivots: Vec<f64>,
    /// Row exchanged with row i in step i.
    exchanges: Vec<usize>,
}

impl Factors {
    /// Memory for matrices of this order.
    pub fn new(order: usize) -> Self {
        Factors {
            order,
            entries: vec![0.0; order * order],
            inverse_pivots: vec![0.0; order],
            exchanges: vec![0; order],
        }
    }

    /// Sets the matrix to `diagonal I - weight J` and factorises it; `jacobian` is column-major, as `nalgebra` stores
    /// it. A singular matrix gives solutions that are not finite, which the step control rejects.
    pub fn factorise(&mut self, diagonal: f64, weight: f64, jacobian: &[f64]) {
        let order = self.order;
        for (column, values) in jacobian.chunks_exact(order).enumerate() {
            for (row, value) in values.iter().enumerate() {
                self.entries[row * order + column] = -weight * value;
            }
        }
        for index in 0..order {
            self.entries[index * order + index] += diagonal;
        }
        for pivot in 0..order {
            let mut largest = pivot;
            for row in pivot + 1..order {
                if self.entries[row * order + pivot].abs() > self.entries[largest * order + pivot].abs() {
                    largest = row;
                }
            }
            self.exchanges[pivot] = largest;
            if largest != pivot {
                let (upper, lower) = self.entries.split_at_mut(largest * order);
                upper[pivot * order..(pivot + 1) * order].swap_with_slice(&mut lower[..order]);
            }
            let inverse = 1.0 / self.entries[pivot * order + pivot];
            self.inverse_pivots[pivot] = inverse;
            let (upper, lower) = self.entries.split_at_mut((pivot + 1) * order);
            let above = &upper[pivot * order..];
            for row in lower.chunks_exact_mut(order) {
                let factor = row[pivot] * inverse;
                row[pivot] = factor;
                for (entry, above) in row[pivot + 1..].iter_mut().zip(&above[pivot + 1..]) {
                    *entry -= factor * above;
                }
            }
        }
    }

    /// Replaces the right-hand side by the solution.
    pub fn solve(&self, right: &mut [f64]) {
        let order = self.order;
        for (index, &other) in self.exchanges.iter().enumerate() {
            right.swap(index, other);
        }
        for (row, entries) in self.entries.chunks_exact(order).enumerate() {
            let (known, rest) = right.split_at_mut(row);
            let sum: f64 = entries.iter().zip(&*known).map(|(entry, value)| entry * value).sum();
            rest[0] -= sum;
        }
        for (row, entries) in self.entries.chunks_exact(order).enumerate().rev() {
            let (rest, known) = right.split_at_mut(row + 1);
            let sum: f64 = entries[row + 1..].iter().zip(&*known).map(|(entry, value)| entry * value).sum();
            rest[row] = (rest[row] - sum) * self.inverse_pivots[row];
        }
    }

    /// Replaces several right-hand sides, row-major with `columns` columns, by their solutions.
    pub fn solve_side_by_side(&self, right: &mut [f64], columns: usize) {
        let order = self.order;
        for (index, &other) in self.exchanges.iter().enumerate() {
            if other != index {
                let (upper, lower) = right.split_at_mut(other * columns);
                upper[index * columns..(index + 1) * columns].swap_with_slice(&mut lower[..columns]);
            }
        }
        for row in 1..order {
            let (known, rest) = right.split_at_mut(row * columns);
            for (entry, values) in self.entries[row * order..].iter().zip(known.chunks_exact(columns)) {
                subtract(&mut rest[..columns], *entry, values);
            }
        }
        for row in (0..order).rev() {
            let (rest, known) = right.split_at_mut((row + 1) * columns);
            let solution = &mut rest[row * columns..];
            for (entry, values) in
                self.entries[row * order + row + 1..(row + 1) * order].iter().zip(known.chunks_exact(columns))
            {
                subtract(solution, *entry, values);
            }
            for value in solution {
                *value *= self.inverse_pivots[row];
            }
        }
    }
}

fn subtract(from: &mut [f64], factor: f64, values: &[f64]) {
    for (slot, value) in from.iter_mut().zip(values) {
        *slot -= factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::Factors;

    /// Needs row exchanges: the diagonal of the first two rows is zero. Column-major.
    const JACOBIAN: [f64; 9] = [1.0, -2.0, 0.5, -3.0, 1.0, 4.0, 2.0, -1.0, 3.0];

    fn times(diagonal: f64, weight: f64, vector: &[f64]) -> Vec<f64> {
        (0..3)
            .map(|row| {
                let sum: f64 = (0..3).map(|column| JACOBIAN[column * 3 + row] * vector[column]).sum();
                diagonal * vector[row] - weight * sum
            })
            .collect()
    }

    #[test]
    fn solutions_satisfy_their_equations() {
        let mut factors = Factors::new(3);
        factors.factorise(1.0, 1.0, &JACOBIAN);
        let wanted = [[3.0, -1.0, 2.0], [0.5, 4.0, -7.0]];
        let mut side_by_side = vec![0.0; 6];
        for (column, solution) in wanted.iter().enumerate() {
            let mut right = times(1.0, 1.0, solution);
            for row in 0..3 {
                side_by_side[row * 2 + column] = right[row];
            }
            factors.solve(&mut right);
            for (found, wanted) in right.iter().zip(solution) {
                assert!((found - wanted).abs() < 1e-13, "{right:?}");
            }
        }
        factors.solve_side_by_side(&mut side_by_side, 2);
        for (column, solution) in wanted.iter().enumerate() {
            for row in 0..3 {
                assert!((side_by_side[row * 2 + column] - solution[row]).abs() < 1e-13, "{side_by_side:?}");
            }
        }
    }

    #[test]
    fn a_singular_matrix_gives_no_finite_solution() {
        let mut factors = Factors::new(3);
        factors.factorise(0.0, 0.0, &JACOBIAN);
        let mut right = [1.0, 2.0, 3.0];
        factors.solve(&mut right);
        assert!(right.iter().any(|value| !value.is_finite()));
    }
}
