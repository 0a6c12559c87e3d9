//! The method of the paper (\[A\] Section 3): differences, moving averages, ordinary least squares on every sample.

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::equation::{Equation, EquationKind, equations};
use super::error::sources;
use super::solution::{ConditionNumber, condition_numbers};
use super::{EquationGauge, Regression, RegressionError, observe};

/// Length of the moving average, samples (\[A\] Section 3.1: "43-order").
const MOVING_AVERAGE: usize = 43;

/// Smallest number of samples per coefficient.
const LEAST_SAMPLES: usize = 5;

/// Identifies the linear coefficients of `model` by ordinary least squares on first differences smoothed by a moving
/// average of 43 samples. It is kept as the baseline: noise in regressors biases it, and its standard errors assume
/// white residuals, which is not the case (`docs/how-it-works.md` has the figures).
///
/// # Errors
/// [`RegressionError`].
pub fn least_squares(model: &Model, recordings: &[&Recording]) -> Result<Regression, RegressionError> {
    let coefficients = Coefficients::of(model);
    let mut values = model.parameter_values();
    let mut variances = vec![None; coefficients.fitted.len()];
    let (mut condition_numbers, mut equations) = (Vec::new(), Vec::new());
    for (group, samples) in coefficients.samples(model, recordings)? {
        let Some(found) = coefficients.solve(model, &samples, recordings)? else { continue };
        for (column, value, error) in found.values {
            values[coefficients.fitted[column]] = value;
            variances[column] = Some(error * error);
        }
        let [unscaled, scaled] = found.conditions;
        condition_numbers.push(ConditionNumber { group, unscaled, scaled });
        equations.push(EquationGauge {
            equation: group.to_string(),
            chi_squared_per_row: f64::NAN,
            relative_residual: found.relative_residual,
            rows: samples.len(),
        });
    }
    let rows = equations.iter().map(|gauge| gauge.rows).sum();
    if rows == 0 {
        return Err(RegressionError::NoEquation {
            source_name: sources(recordings),
            machine: model.machine.name.clone(),
            missing: "check which of displacement, pressures, opening and force are measured".into(),
        });
    }
    let variance_of = |index: usize| {
        let column = coefficients.fitted.iter().position(|&candidate| candidate == index)?;
        variances[column]
    };
    let mut improved = model.clone();
    improved.set_parameter_values(&values);
    for (index, parameter) in improved.parameters_mut().enumerate() {
        if let Some(variance) = variance_of(index) {
            parameter.standard_error = Some(variance.sqrt());
            parameter.source = "identified by least squares".into();
        }
    }
    let unseen = model.unknown_parameters().into_iter().filter(|&index| variance_of(index).is_none());
    let not_identified = unseen
        .map(|index| (index, "not linear, or its equation has signals that are not measured".to_string()))
        .collect();
    let diagonal: Vec<f64> = variances.iter().map(|variance| variance.unwrap_or(0.0)).collect();
    Ok(Regression {
        model: improved,
        fitted: coefficients.fitted.iter().copied().filter(|&index| variance_of(index).is_some()).collect(),
        covariance: DMatrix::from_diagonal(&DVector::from_vec(diagonal)),
        condition_numbers,
        rows,
        equations,
        not_identified,
    })
}

/// Regressors and right-hand side of each sample.
type Samples = Vec<(DVector<f64>, f64)>;

/// The coefficients that rows are linear in: one over the parameter if that is its kind.
struct Coefficients {
    /// Indices of their parameters.
    fitted: Vec<usize>,
    kinds: Vec<Kind>,
}

/// The coefficients of one group of equations.
struct Found {
    /// Column, value and standard error of each parameter.
    values: Vec<(usize, f64, f64)>,
    /// Condition number of the regressors in SI units, and with scaled columns.
    conditions: [f64; 2],
    relative_residual: f64,
}

impl Coefficients {
    fn of(model: &Model) -> Self {
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| &*parameter.card).collect();
        let fitted: Vec<usize> =
            model.unknown_parameters().into_iter().filter(|&index| cards[index].kind != Kind::Shape).collect();
        let kinds = fitted.iter().map(|&index| cards[index].kind).collect();
        Coefficients { fitted, kinds }
    }

    /// Rows of the mechanical and of the hydraulic equations.
    fn samples(
        &self,
        model: &Model,
        recordings: &[&Recording],
    ) -> Result<[(&'static str, Samples); 2], RegressionError> {
        let values = model.parameter_values();
        let system = System::new(model);
        let mut groups: [(&'static str, Samples); 2] = [("mechanical", vec![]), ("hydraulic", vec![])];
        for recording in recordings {
            let observation = averaged(observe(model, recording)?);
            let effect_states = vec![Vec::new(); recording.len()];
            for equation in equations(&system, &observation, &effect_states, &self.fitted) {
                let group = usize::from(!matches!(equation.kind, EquationKind::Motion(_)));
                for (mut regressors, residual) in samples(&equation, &observation.time, self.fitted.len()) {
                    let mut known = 0.0;
                    for (c, (&index, kind)) in self.fitted.iter().zip(&self.kinds).enumerate() {
                        let (slope, coefficient) = match kind {
                            Kind::Reciprocal => (-values[index] * values[index], 1.0 / values[index]),
                            Kind::Linear | Kind::Shape => (1.0, values[index]),
                        };
                        regressors[c] *= slope;
                        known += regressors[c] * coefficient;
                    }
                    // Rows are linear in the coefficients, so the residual at zero coefficients is the right-hand side.
                    groups[group].1.push((regressors, known - residual));
                }
            }
        }
        Ok(groups)
    }

    /// `X c = y` by Cholesky's factors of `X^T X` with columns of length one; X is samples times coefficients. `None` if no
    /// coefficient appears.
    fn solve(
        &self,
        model: &Model,
        samples: &Samples,
        recordings: &[&Recording],
    ) -> Result<Option<Found>, RegressionError> {
        let columns: Vec<usize> =
            (0..self.fitted.len()).filter(|&c| samples.iter().any(|(regressors, _)| regressors[c] != 0.0)).collect();
        if columns.is_empty() {
            return Ok(None);
        }
        let (rows, needed) = (samples.len(), LEAST_SAMPLES * columns.len());
        if rows < needed {
            let (source_name, parameters) = (sources(recordings), columns.len());
            return Err(RegressionError::TooFewRows { source_name, rows, parameters, needed });
        }
        let matrix = DMatrix::from_fn(rows, columns.len(), |r, c| samples[r].0[columns[c]]);
        let right = DVector::from_iterator(rows, samples.iter().map(|(_, right)| *right));
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        let scaled = DMatrix::from_fn(rows, columns.len(), |r, c| matrix[(r, c)] / lengths[c]);
        let information = scaled.transpose() * &scaled;
        let Some(factor) = information.cholesky() else {
            let all = model.parameter_names();
            let names = columns.iter().map(|&c| all[self.fitted[c]].clone()).collect();
            return Err(RegressionError::NotIdentifiable { source_name: sources(recordings), names });
        };
        let solution = factor.solve(&(scaled.transpose() * &right));
        let residual = &right - &scaled * &solution;
        let variance = residual.norm_squared() / (rows - columns.len()) as f64;
        let inverse = factor.inverse();
        let value = |(position, &column): (usize, &usize)| {
            let coefficient = solution[position] / lengths[position];
            let deviation = (variance * inverse[(position, position)]).sqrt() / lengths[position];
            match self.kinds[column] {
                Kind::Reciprocal => (column, 1.0 / coefficient, deviation / (coefficient * coefficient)),
                Kind::Linear | Kind::Shape => (column, coefficient, deviation),
            }
        };
        let (unscaled, scaled_condition) = condition_numbers(&matrix);
        Ok(Some(Found {
            values: columns.iter().enumerate().map(value).collect(),
            conditions: [unscaled, scaled_condition],
            relative_residual: residual.norm() / right.norm(),
        }))
    }
}

/// Regressors and residual of an equation at each sample where all signals are measured.
fn samples(equation: &Equation, time: &[f64], parameters: usize) -> Vec<(DVector<f64>, f64)> {
    let derivatives: Vec<Vec<f64>> = equation
        .terms
        .iter()
        .map(|term| (0..term.order).fold(term.quantity.clone(), |signal, _| moving_average(&difference(time, &signal))))
        .collect();
    // Differences and averages near the ends reach outside the recording.
    let edge = 2 * MOVING_AVERAGE;
    (edge..time.len().saturating_sub(edge))
        .filter_map(|sample| {
            let mut residual = -equation.rest[sample];
            let mut regressors = DVector::<f64>::zeros(parameters);
            for (term, derivative) in equation.terms.iter().zip(&derivatives) {
                residual += term.storage[sample] * derivative[sample];
                for (c, column) in term.by_parameter.iter().enumerate().filter(|(_, column)| !column.is_empty()) {
                    regressors[c] += column[sample] * derivative[sample];
                }
            }
            for (c, column) in equation.rest_by_parameter.iter().enumerate().filter(|(_, column)| !column.is_empty()) {
                regressors[c] -= column[sample];
            }
            (residual.is_finite() && regressors.iter().all(|value| value.is_finite())).then_some((regressors, residual))
        })
        .collect()
}

/// The observation with signals smoothed as in the paper.
fn averaged(mut observation: super::Observation) -> super::Observation {
    let time = observation.time.clone();
    for cylinder in &mut observation.cylinders {
        cylinder.velocity = moving_average(&difference(&time, &cylinder.displacement));
        cylinder.smooth_displacement.clone_from(&cylinder.displacement);
    }
    observation.with_measured_pressures()
}

fn difference(time: &[f64], signal: &[f64]) -> Vec<f64> {
    let mut slopes: Vec<f64> =
        time.windows(2).zip(signal.windows(2)).map(|(t, x)| (x[1] - x[0]) / (t[1] - t[0])).collect();
    slopes.push(slopes.last().copied().unwrap_or(f64::NAN));
    slopes
}

fn moving_average(signal: &[f64]) -> Vec<f64> {
    let half = MOVING_AVERAGE / 2;
    (0..signal.len())
        .map(|index| {
            let window = &signal[index.saturating_sub(half)..(index + half + 1).min(signal.len())];
            window.iter().sum::<f64>() / window.len() as f64
        })
        .collect()
}
