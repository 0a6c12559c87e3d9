//! Projects a model's own parameters out of its residual and out of further terms.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::regression::{EquationKind, WeakTerms};

/// Rows of the weak form with the model's own parameters projected out, on fitted recordings and on predicted ones.
pub(super) struct Projection {
    fitted: Rows,
    predicted: Rows,
    /// Normal equations of the model's own parameters.
    normal: Option<Cholesky<f64, Dyn>>,
}

/// The rows of one kind of recordings.
struct Rows {
    kinds: Vec<usize>,
    weights: Vec<f64>,
    regressors: DMatrix<f64>,
    /// The residual after the model's own parameters.
    left: Vec<f64>,
    /// Independent rows of each equation.
    counts: Vec<f64>,
}

/// A term with the model's own parameters projected out.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub fitted: Vec<f64>,
    pub predicted: Vec<f64>,
}

/// Smallest part of a term that may remain. A term with a smaller rest is a combination of the model's own parameters.
const LEAST_REST: f64 = 1e-5;

/// Increase of the diagonal of the normal equations, for columns of length one. Two parameters that the rows cannot
/// separate then share their effect.
const RIDGE: f64 = 1e-9;

impl Projection {
    /// Projects the parameters out of the residuals. Equations with residuals larger than noise explains have less
    /// weight.
    pub fn new(fitted: &WeakTerms<'_>, predicted: &WeakTerms<'_>) -> Projection {
        let mut equations: Vec<EquationKind> = fitted.kinds.iter().chain(&predicted.kinds).copied().collect();
        equations.sort();
        equations.dedup();
        let mut projection = Projection {
            fitted: Rows::new(fitted, &equations),
            predicted: Rows::new(predicted, &equations),
            normal: None,
        };
        let residuals = [residuals(fitted), residuals(predicted)];
        for _ in 0..2 {
            projection.normal = normal(&projection.fitted);
            let own = projection.own_parameters(&weighed(&residuals[0], &projection.fitted.weights));
            let Projection { fitted, predicted, .. } = &mut projection;
            fitted.left = fitted.rest(&residuals[0], &own);
            predicted.left = predicted.rest(&residuals[1], &own);
            let spreads = fitted.spreads(&fitted.left);
            fitted.weights = fitted.kinds.iter().map(|&kind| 1.0 / spreads[kind].sqrt()).collect();
        }
        projection
    }

    /// The model's own parameters that fit a weighted column best.
    fn own_parameters(&self, weighed: &[f64]) -> DVector<f64> {
        let columns = self.fitted.regressors.column_iter().map(|column| {
            let products = column.iter().zip(&self.fitted.weights).zip(weighed);
            products.map(|((slope, weight), value)| slope * weight * value).sum::<f64>()
        });
        let right = DVector::from_iterator(self.fitted.regressors.ncols(), columns);
        self.normal.as_ref().map_or_else(|| DVector::zeros(right.len()), |normal| normal.solve(&right))
    }

    /// A term with the model's own parameters projected out; `None` for a combination of these.
    pub fn column(&self, fitted: &[f64], predicted: &[f64]) -> Option<Column> {
        let own = self.own_parameters(&weighed(fitted, &self.fitted.weights));
        let column = Column { fitted: self.fitted.rest(fitted, &own), predicted: self.predicted.rest(predicted, &own) };
        let is_left = self.product(&column.fitted, &column.fitted) > LEAST_REST * self.product(fitted, fitted);
        is_left.then_some(column)
    }

    /// Coefficient of a term, and the growth of the log-likelihood with it on fitted and on predicted recordings. Each
    /// equation has its own variance.
    pub fn gain(&self, column: &Column) -> Option<(f64, f64)> {
        let coefficient =
            self.product(&column.fitted, &self.fitted.left) / self.product(&column.fitted, &column.fitted);
        let gain = |rows: &Rows, column: &[f64]| {
            let left: Vec<f64> = rows.left.iter().zip(column).map(|(left, value)| left - coefficient * value).collect();
            let (before, after) = (rows.spreads(&rows.left), rows.spreads(&left));
            let each = before.iter().zip(&after).zip(&rows.counts);
            each.map(|((before, after), count)| 0.5 * count * (before / after).ln()).sum::<f64>()
        };
        let both = gain(&self.fitted, &column.fitted) + gain(&self.predicted, &column.predicted);
        both.is_finite().then_some((coefficient, both))
    }

    /// Product of two columns of the fitted recordings, each row by its weight.
    fn product(&self, one: &[f64], other: &[f64]) -> f64 {
        one.iter().zip(other).zip(&self.fitted.weights).map(|((a, b), weight)| a * b * weight * weight).sum()
    }

    /// Absolute cosine of the angle between two terms.
    pub fn likeness(&self, one: &Column, other: &Column) -> f64 {
        let lengths = self.product(&one.fitted, &one.fitted) * self.product(&other.fitted, &other.fitted);
        self.product(&one.fitted, &other.fitted).abs() / lengths.sqrt()
    }

    /// Independent rows of all recordings.
    pub fn independent(&self) -> f64 {
        self.fitted.counts.iter().chain(&self.predicted.counts).sum()
    }
}

/// Smallest mean square of an equation, in units of what sensor noise explains.
const LEAST_SPREAD: f64 = 1e-3;

impl Rows {
    fn new(terms: &WeakTerms<'_>, equations: &[EquationKind]) -> Rows {
        let kinds: Vec<usize> = terms.kinds.iter().map(|kind| equations.binary_search(kind).unwrap_or(0)).collect();
        let mut counts = vec![0.0; equations.len()];
        kinds.iter().for_each(|&kind| counts[kind] += terms.independent);
        let mut regressors = terms.regressors.clone();
        // A parameter with a slope that is not finite somewhere is not fitted.
        for mut column in regressors.column_iter_mut() {
            if column.iter().any(|slope| !slope.is_finite()) {
                column.fill(0.0);
            }
        }
        Rows { weights: vec![1.0; kinds.len()], left: Vec::new(), regressors, kinds, counts }
    }

    /// A column with the model's own parameters projected out.
    fn rest(&self, column: &[f64], own: &DVector<f64>) -> Vec<f64> {
        let explained = &self.regressors * own;
        column.iter().zip(explained.iter()).map(|(value, explained)| value - explained).collect()
    }

    /// Mean square in each equation, in units of what sensor noise explains. Much smaller values are rounding.
    fn spreads(&self, left: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0.0); self.counts.len()];
        for (&kind, value) in self.kinds.iter().zip(left) {
            sums[kind].0 += value * value;
            sums[kind].1 += 1.0;
        }
        sums.into_iter().map(|(squares, count): (f64, f64)| (squares / count.max(1.0)).max(LEAST_SPREAD)).collect()
    }
}

/// The residuals that terms have to explain.
fn residuals(terms: &WeakTerms<'_>) -> Vec<f64> {
    terms.residuals.iter().map(|residual| -residual).collect()
}

fn weighed(column: &[f64], weights: &[f64]) -> Vec<f64> {
    column.iter().zip(weights).map(|(value, weight)| value * weight).collect()
}

fn normal(rows: &Rows) -> Option<Cholesky<f64, Dyn>> {
    let mut weighed = rows.regressors.clone();
    for (mut row, weight) in weighed.row_iter_mut().zip(&rows.weights) {
        row *= *weight;
    }
    let mut matrix = weighed.transpose() * &weighed;
    for index in 0..matrix.nrows() {
        // Relative to its own size, so that units do not matter. A column of zeros gets a parameter of zero.
        let own = matrix[(index, index)];
        matrix[(index, index)] = if own > 0.0 { own * (1.0 + RIDGE) } else { 1.0 };
    }
    matrix.cholesky()
}
