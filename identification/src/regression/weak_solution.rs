//! Solves one round of the weak form: parameters and their covariance from rows and instruments.

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::equation::EquationKind;
use super::solution::{ConditionNumber, condition_numbers};
use super::weak_covariance::{STRETCH, jackknife};
use super::weak_form::sources;
use super::weak_rows::Row;
use super::{EquationGauge, Regression, RegressionError, WeakFormSettings};
use crate::fit::ParameterPriors;

/// Solves for the parameters that fit the rows best, with instruments.
pub(super) fn solve(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    unknown: &[usize],
    rows: &[Row],
    with_errors: bool,
) -> Result<Regression, RegressionError> {
    let cards: Vec<_> = model.parameters().map(|(_, parameter)| &*parameter.card).collect();
    let values = model.parameter_values();
    // The regression solves for coefficients, which are one over the parameter if rows are linear in that.
    let slope_to_coefficient = |index: usize| match cards[index].kind {
        Kind::Reciprocal => -values[index] * values[index],
        Kind::Linear | Kind::Shape => 1.0,
    };
    let seen: Vec<usize> =
        (0..unknown.len()).filter(|&column| rows.iter().any(|row| row.regressors[column] != 0.0)).collect();
    let names = model.parameter_names();
    if seen.is_empty() {
        return Err(RegressionError::NoEquation {
            source_name: sources(recordings),
            machine: model.machine.name.clone(),
            missing: "check which of displacement, pressures, opening and force are measured, and that the arm moves"
                .into(),
        });
    }
    let (half_width, step_width) = settings.widths(model, recordings);
    let independent = rows.len() as f64 * step_width / (2.0 * half_width);
    if independent < seen.len() as f64 * 2.0 {
        return Err(RegressionError::TooFewRows {
            source_name: sources(recordings),
            rows: rows.len(),
            parameters: seen.len(),
            needed: (seen.len() as f64 * 4.0 * half_width / step_width) as usize,
        });
    }

    let mut kinds: Vec<EquationKind> = rows.iter().map(|row| row.kind).collect();
    kinds.sort();
    kinds.dedup();
    let gauges = gauges(model, &kinds, rows);
    // An equation with residuals larger than noise explains gets a weight according to its residuals.
    let trust = |kind: EquationKind| {
        let position = kinds.iter().position(|candidate| *candidate == kind).unwrap_or(0);
        1.0 / gauges[position].chi_squared_per_row.max(1.0).sqrt()
    };

    let mut regressors = DMatrix::zeros(rows.len(), seen.len());
    let mut instruments = DMatrix::zeros(rows.len(), seen.len());
    let mut residuals = DVector::zeros(rows.len());
    for (number, row) in rows.iter().enumerate() {
        let trust = trust(row.kind);
        residuals[number] = row.residual * trust;
        for (column, &index) in seen.iter().enumerate() {
            let factor = slope_to_coefficient(unknown[index]) * trust;
            regressors[(number, column)] = row.regressors[index] * factor;
            instruments[(number, column)] = row.instruments[index] * factor;
        }
    }
    let lengths: Vec<f64> = regressors.column_iter().map(|column| column.norm()).collect();
    let mut own_lengths = Vec::new();
    for (column, &length) in lengths.iter().enumerate() {
        regressors.column_mut(column).scale_mut(1.0 / length);
        let own = instruments.column(column).norm();
        own_lengths.push(own);
        instruments.column_mut(column).scale_mut(if own > 0.0 { 1.0 / own } else { 0.0 });
    }
    let mut matrix = instruments.transpose() * &regressors;
    let mut right = instruments.transpose() * &residuals;
    // The prior of each nuisance parameter counts as one more row.
    let fitted: Vec<usize> = seen.iter().map(|&index| unknown[index]).collect();
    let priors = ParameterPriors::of(model, &fitted, recordings, 0);
    let equations = priors.equations(&values, &vec![1.0; fitted.len()]);
    for (column, (information, gradient)) in equations.into_iter().enumerate() {
        let scale = 1.0 / lengths[column];
        let instrument_scale = if own_lengths[column] > 0.0 { 1.0 / own_lengths[column] } else { scale };
        matrix[(column, column)] += information * scale * instrument_scale;
        right[column] -= gradient * instrument_scale;
    }
    // The iterations are bounded: on a matrix with a NaN the plain decomposition never ends.
    let Some(svd) = matrix.clone().try_svd(true, true, f64::EPSILON, 10_000) else {
        let names = seen.iter().map(|&index| names[unknown[index]].clone()).collect();
        return Err(RegressionError::NotIdentifiable { source_name: sources(recordings), names });
    };
    if svd.singular_values.min() < 1e-9 * svd.singular_values.max() {
        let weakest = svd.singular_values.imin();
        let involved = svd.v_t.as_ref().map_or(Vec::new(), |v_t| {
            let row = v_t.row(weakest);
            let largest = row.amax();
            (0..seen.len()).filter(|&c| row[c].abs() > 0.3 * largest).map(|c| names[unknown[seen[c]]].clone()).collect()
        });
        return Err(RegressionError::NotIdentifiable { source_name: sources(recordings), names: involved });
    }
    let Some(inverse) = matrix.try_inverse() else {
        let names = seen.iter().map(|&index| names[unknown[index]].clone()).collect();
        return Err(RegressionError::NotIdentifiable { source_name: sources(recordings), names });
    };
    let step = -(&inverse * right);
    let remaining = &residuals + &regressors * &step;

    let mut improved = model.clone();
    let mut new_values = values.clone();
    for (column, &index) in seen.iter().enumerate() {
        let parameter = unknown[index];
        let card = cards[parameter];
        let change = step[column] / lengths[column];
        new_values[parameter] = match card.kind {
            Kind::Reciprocal => {
                let coefficient = (1.0 / values[parameter] + change).max(1.0 / card.maximum);
                1.0 / coefficient
            }
            Kind::Linear => values[parameter] + change,
            Kind::Shape => (values[parameter] + change).clamp(priors.bounds[parameter][0], priors.bounds[parameter][1]),
        };
    }
    improved.set_parameter_values(&new_values);

    let (coefficient_covariance, quantiles) = if with_errors {
        let spread = jackknife(rows, &instruments, &regressors, &remaining, STRETCH * model.machine.size().time());
        (spread.covariance, spread.quantiles)
    } else {
        (DMatrix::from_element(seen.len(), seen.len(), f64::NAN), DVector::from_element(seen.len(), f64::NAN))
    };
    let mut covariance = DMatrix::zeros(seen.len(), seen.len());
    let to_parameter = |column: usize| {
        let parameter = unknown[seen[column]];
        let slope = match cards[parameter].kind {
            Kind::Reciprocal => -new_values[parameter] * new_values[parameter],
            Kind::Linear | Kind::Shape => 1.0,
        };
        slope / lengths[column]
    };
    for row in 0..seen.len() {
        for column in 0..seen.len() {
            covariance[(row, column)] =
                coefficient_covariance[(row, column)] * to_parameter(row) * to_parameter(column);
        }
    }
    for (index, parameter) in improved.parameters_mut().enumerate() {
        if let Some(column) = seen.iter().position(|&s| unknown[s] == index) {
            let variance = covariance[(column, column)];
            parameter.standard_error = variance.is_finite().then(|| variance.max(0.0).sqrt());
            parameter.margin_95 = parameter.standard_error.map(|error| quantiles[column] * error);
            parameter.source = "identified".into();
        }
    }
    let not_identified = (0..unknown.len())
        .filter(|index| !seen.contains(index))
        .map(|index| {
            (unknown[index], "no equation that contains it has all its signals measured, with motion".to_string())
        })
        .collect();
    Ok(Regression {
        model: improved,
        fitted: seen.iter().map(|&index| unknown[index]).collect(),
        covariance,
        condition_numbers: if with_errors {
            group_conditions(rows, &seen, |index| slope_to_coefficient(unknown[index]))
        } else {
            Vec::new()
        },
        rows: rows.len(),
        equations: gauges,
        not_identified,
    })
}

fn gauges(model: &Model, kinds: &[EquationKind], rows: &[Row]) -> Vec<EquationGauge> {
    kinds
        .iter()
        .map(|&kind| {
            let own: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
            let count = own.len() as f64;
            EquationGauge {
                equation: kind.name(model),
                chi_squared_per_row: own.iter().map(|row| row.residual * row.residual).sum::<f64>() / count,
                relative_residual: (own.iter().map(|row| row.relative * row.relative).sum::<f64>() / count).sqrt(),
                rows: own.len(),
            }
        })
        .collect()
}

/// Condition numbers of the mechanical and the hydraulic regressors, as \[A\] Section 3.2 reports them.
fn group_conditions(rows: &[Row], seen: &[usize], factor: impl Fn(usize) -> f64) -> Vec<ConditionNumber> {
    type Belongs = fn(&EquationKind) -> bool;
    let groups: [(&'static str, Belongs); 2] = [
        ("mechanical", |kind| matches!(kind, EquationKind::Motion(_))),
        ("hydraulic", |kind| !matches!(kind, EquationKind::Motion(_))),
    ];
    groups
        .into_iter()
        .filter_map(|(group, belongs)| {
            let own: Vec<&Row> = rows.iter().filter(|row| belongs(&row.kind)).collect();
            let columns: Vec<usize> =
                seen.iter().copied().filter(|&c| own.iter().any(|row| row.regressors[c] != 0.0)).collect();
            if own.is_empty() || columns.is_empty() {
                return None;
            }
            let matrix = DMatrix::from_fn(own.len(), columns.len(), |r, c| {
                own[r].regressors[columns[c]] * own[r].noise * factor(columns[c])
            });
            let (unscaled, scaled) = condition_numbers(&matrix);
            Some(ConditionNumber { group, unscaled, scaled })
        })
        .collect()
}
