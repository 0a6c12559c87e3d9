//! The method of the paper (\[A\] Section 3): differences, moving averages, ordinary least squares on every sample.

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::equation::{Equation, EquationKind, equations};
use super::solution::{ConditionNumber, condition_numbers};
use super::weak_form::sources;
use super::{EquationGauge, Regression, RegressionError, observe};

/// Length of the moving average, samples (\[A\] Section 3.1: "43-order").
const MOVING_AVERAGE: usize = 43;

/// Identifies the linear coefficients of `model` by ordinary least squares on first differences smoothed by a moving
/// average of 43 samples. It is kept as the baseline: noise in regressors biases it, and its standard errors assume
/// white residuals, which is not the case (`docs/how-it-works.md` has the figures).
///
/// # Errors
/// [`RegressionError`].
pub fn least_squares(model: &Model, recordings: &[&Recording]) -> Result<Regression, RegressionError> {
    let cards: Vec<_> = model.parameters().map(|(_, parameter)| &*parameter.card).collect();
    let fitted: Vec<usize> =
        model.unknown_parameters().into_iter().filter(|&index| cards[index].kind != Kind::Shape).collect();
    let mut values = model.parameter_values();
    let coefficient_slope = |index: usize, value: f64| match cards[index].kind {
        Kind::Reciprocal => -value * value,
        Kind::Linear | Kind::Shape => 1.0,
    };
    let system = System::new(model);
    // Regressors and right-hand side of each sample.
    type Samples = Vec<(DVector<f64>, f64)>;
    let mut groups: [(&'static str, Samples); 2] = [("mechanical", vec![]), ("hydraulic", vec![])];
    for recording in recordings {
        let observation = averaged(observe(model, recording)?);
        let effect_states = vec![Vec::new(); recording.len()];
        for equation in equations(&system, &observation, &effect_states, &fitted) {
            let group = usize::from(!matches!(equation.kind, EquationKind::Motion(_)));
            for (regressors, residual) in samples(&equation, &observation.time, fitted.len()) {
                let regressors = DVector::from_fn(fitted.len(), |c, _| {
                    regressors[c] * coefficient_slope(fitted[c], values[fitted[c]])
                });
                let known = fitted.iter().enumerate().map(|(c, &index)| {
                    let coefficient =
                        if cards[index].kind == Kind::Reciprocal { 1.0 / values[index] } else { values[index] };
                    regressors[c] * coefficient
                });
                // Rows are linear in the coefficients, so the residual at zero coefficients is the right-hand side.
                let right = -(residual - known.sum::<f64>());
                groups[group].1.push((regressors, right));
            }
        }
    }
    let mut covariance = DMatrix::zeros(fitted.len(), fitted.len());
    let mut conditions = Vec::new();
    let mut seen = vec![false; fitted.len()];
    let mut rows = 0;
    let mut equations_gauges = Vec::new();
    for (group, samples) in groups {
        let columns: Vec<usize> =
            (0..fitted.len()).filter(|&c| samples.iter().any(|(regressors, _)| regressors[c] != 0.0)).collect();
        if columns.is_empty() {
            continue;
        }
        if samples.len() < 5 * columns.len() {
            return Err(RegressionError::TooFewRows {
                source_name: sources(recordings),
                rows: samples.len(),
                parameters: columns.len(),
                needed: 5 * columns.len(),
            });
        }
        let matrix = DMatrix::from_fn(samples.len(), columns.len(), |r, c| samples[r].0[columns[c]]);
        let right = DVector::from_iterator(samples.len(), samples.iter().map(|(_, right)| *right));
        let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        let scaled = DMatrix::from_fn(samples.len(), columns.len(), |r, c| matrix[(r, c)] / lengths[c]);
        let information = scaled.transpose() * &scaled;
        let names = model.parameter_names();
        let Some(factor) = information.cholesky() else {
            return Err(RegressionError::NotIdentifiable {
                source_name: sources(recordings),
                names: columns.iter().map(|&c| names[fitted[c]].clone()).collect(),
            });
        };
        let solution = factor.solve(&(scaled.transpose() * &right));
        let residual = &right - &scaled * &solution;
        let variance = residual.norm_squared() / (samples.len() - columns.len()) as f64;
        let inverse = factor.inverse();
        for (position, &column) in columns.iter().enumerate() {
            let index = fitted[column];
            let coefficient = solution[position] / lengths[position];
            let deviation = (variance * inverse[(position, position)]).sqrt() / lengths[position];
            let (value, error) = match cards[index].kind {
                Kind::Reciprocal => (1.0 / coefficient, deviation / (coefficient * coefficient)),
                Kind::Linear | Kind::Shape => (coefficient, deviation),
            };
            values[index] = value;
            covariance[(column, column)] = error * error;
            seen[column] = true;
        }
        let (unscaled, scaled_condition) = condition_numbers(&matrix);
        conditions.push(ConditionNumber { group, unscaled, scaled: scaled_condition });
        rows += samples.len();
        equations_gauges.push(EquationGauge {
            equation: group.to_string(),
            chi_squared_per_row: f64::NAN,
            relative_residual: residual.norm() / right.norm(),
            rows: samples.len(),
        });
    }
    if rows == 0 {
        return Err(RegressionError::NoEquation {
            source_name: sources(recordings),
            machine: model.machine.name.clone(),
            missing: "check which of displacement, pressures, opening and force are measured".into(),
        });
    }
    let mut improved = model.clone();
    improved.set_parameter_values(&values);
    for (index, parameter) in improved.parameters_mut().enumerate() {
        if let Some(column) = fitted.iter().position(|&candidate| candidate == index)
            && seen[column]
        {
            parameter.standard_error = Some(covariance[(column, column)].sqrt());
            parameter.source = "identified by least squares".into();
        }
    }
    let not_identified = model
        .unknown_parameters()
        .into_iter()
        .filter(|index| !fitted.iter().zip(&seen).any(|(candidate, seen)| candidate == index && *seen))
        .map(|index| (index, "not linear, or its equation has signals that are not measured".to_string()))
        .collect();
    Ok(Regression {
        model: improved,
        fitted: fitted.iter().zip(&seen).filter(|(_, seen)| **seen).map(|(index, _)| *index).collect(),
        covariance,
        condition_numbers: conditions,
        rows,
        equations: equations_gauges,
        not_identified,
    })
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
        cylinder.smooth_pressures = cylinder.pressures.clone();
    }
    observation.smooth_pump_pressure.clone_from(&observation.pump_pressure);
    observation
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
