//! Results of a regression.

use excavator_model::Model;
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::fit::Simplified;
use crate::nullable::Nullable;

/// Result of a regression.
#[derive(Debug, Clone)]
pub struct Regression {
    /// The model with the identified parameters and their standard errors.
    pub model: Model,
    /// Indices of the identified parameters, in the model's order.
    pub fitted: Vec<usize>,
    /// Their covariance, in their units.
    pub covariance: DMatrix<f64>,
    /// Condition number of each group of equations, unscaled as in \[A\] and with columns scaled to length one.
    pub condition_numbers: Vec<ConditionNumber>,
    /// Rows of the regression.
    pub rows: usize,
    /// Goodness of fit of each equation.
    pub equations: Vec<EquationGauge>,
    /// Parameters that occur in no equation whose signals are measured, with the reason.
    pub not_identified: Vec<(usize, String)>,
}

impl Regression {
    /// Removes the nuisance effects that `given` lacks and that do not differ from their neutral value.
    #[must_use]
    pub fn simplified(self, given: &Model) -> Self {
        let simple = Simplified::of(given, &self.model);
        let (places, fitted): (Vec<usize>, Vec<usize>) =
            self.fitted.iter().enumerate().filter_map(|(place, &index)| Some((place, simple.index(index)?))).unzip();
        let covariance = self.covariance.select_rows(&places).select_columns(&places);
        let not_identified = self.not_identified.iter();
        let not_identified =
            not_identified.filter_map(|(index, reason)| Some((simple.index(*index)?, reason.clone()))).collect();
        Regression { model: simple.model, fitted, covariance, not_identified, ..self }
    }
}

/// Condition number of a group of equations.
#[derive(Debug, Clone, PartialEq)]
pub struct ConditionNumber {
    /// "mechanical", "hydraulic".
    pub group: &'static str,
    /// Condition number of the unscaled regressor matrix, in SI units.
    pub unscaled: f64,
    /// Condition number with columns scaled to length one, which is the numerically relevant one.
    pub scaled: f64,
}

/// How well an equation is met.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EquationGauge {
    /// Name: `arm.motion`, `pump.continuity`.
    pub equation: String,
    /// Mean squared residual over what sensor noise explains; 1 where nothing is missing. `null` for least squares, which knows no noise.
    #[serde(with = "Nullable")]
    pub chi_squared_per_row: f64,
    /// Root mean square of the residual, as a share of the equation's own size.
    #[serde(with = "Nullable")]
    pub relative_residual: f64,
    /// Rows of the equation.
    pub rows: usize,
}

/// Ratio of largest to smallest singular value of a matrix, unscaled and with columns scaled to length one.
pub(super) fn condition_numbers(matrix: &DMatrix<f64>) -> (f64, f64) {
    let ratio = |singular: &nalgebra::DVector<f64>| singular.max() / singular.min();
    let plain = matrix.clone().svd(false, false).singular_values;
    let mut scaled = matrix.clone();
    for mut column in scaled.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    let scaled = scaled.svd(false, false).singular_values;
    if plain.is_empty() { (f64::NAN, f64::NAN) } else { (ratio(&plain), ratio(&scaled)) }
}
