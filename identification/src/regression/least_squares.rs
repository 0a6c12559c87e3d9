//! The method of the paper (\[A\] Section 3): differences, moving averages, ordinary least squares on every sample.

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::error::sources;
use super::printed_rows::{Coefficients, MOVING_AVERAGE, PrintedRow};
use super::robust_covariance::newey_west;
use super::solution::{ConditionNumber, condition_numbers};
use super::{EquationGauge, Regression, RegressionError};

/// Smallest number of samples per coefficient.
const LEAST_SAMPLES: usize = 5;

/// Samples over which residuals are taken to be correlated: noise is averaged twice for the acceleration, and the weights of the
/// covariance fall linearly to zero over this length.
const CORRELATED: usize = 4 * MOVING_AVERAGE;

/// Half width of a 95 % interval in standard errors. Thousands of rows make the normal distribution exact enough.
const NORMAL_95: f64 = 1.96;

/// Identifies the linear coefficients of `model` by ordinary least squares on the rows that \[A\] Eq. 6-8 print: first differences
/// smoothed by a moving average of 43 samples, pressures as measured, signs and roots without rounding, and no term for end stops
/// and boiling oil.
///
/// Standard errors hold for residuals that are correlated over time. They say nothing of the bias from noise in the regressors,
/// for which `docs/papers.md` has the figures.
///
/// # Errors
/// [`RegressionError`].
pub fn least_squares(model: &Model, recordings: &[&Recording]) -> Result<Regression, RegressionError> {
    let coefficients = Coefficients::of(model);
    let count = coefficients.parameters.len();
    let mut values = model.parameter_values();
    let mut covariance = DMatrix::<f64>::zeros(count, count);
    let mut seen = vec![false; count];
    let (mut condition_numbers, mut equations) = (Vec::new(), Vec::new());
    for (group, rows) in coefficients.rows(model, recordings)? {
        let Some(found) = solve(&coefficients, model, &rows, recordings)? else { continue };
        for (place, &column) in found.columns.iter().enumerate() {
            values[coefficients.parameters[column]] = found.values[place];
            seen[column] = true;
            for (other, &across) in found.columns.iter().enumerate() {
                covariance[(column, across)] = found.covariance[(place, other)];
            }
        }
        let [unscaled, scaled] = found.conditions;
        condition_numbers.push(ConditionNumber { group, unscaled, scaled });
        equations.push(EquationGauge {
            equation: group.to_string(),
            chi_squared_per_row: f64::NAN,
            relative_residual: found.relative_residual,
            rows: rows.len(),
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
    let found: Vec<usize> = (0..count).filter(|&column| seen[column]).collect();
    let mut improved = model.clone();
    improved.set_parameter_values(&values);
    for (index, parameter) in improved.parameters_mut().enumerate() {
        if let Some(&column) = found.iter().find(|&&column| coefficients.parameters[column] == index) {
            let error = covariance[(column, column)].max(0.0).sqrt();
            parameter.standard_error = Some(error);
            parameter.margin_95 = Some(NORMAL_95 * error);
            parameter.source = "identified by least squares".into();
        }
    }
    let fitted: Vec<usize> = found.iter().map(|&column| coefficients.parameters[column]).collect();
    let unseen = model.unknown_parameters().into_iter().filter(|index| !fitted.contains(index));
    let not_identified = unseen
        .map(|index| (index, "not linear, or its equation has signals that are not measured".to_string()))
        .collect();
    Ok(Regression {
        model: improved,
        fitted,
        covariance: covariance.select_rows(&found).select_columns(&found),
        condition_numbers,
        rows,
        equations,
        not_identified,
    })
}

/// The parameters of one group of equations.
struct Found {
    /// Their columns among the coefficients.
    columns: Vec<usize>,
    values: Vec<f64>,
    covariance: DMatrix<f64>,
    /// Condition number of the regressors in SI units, and with scaled columns.
    conditions: [f64; 2],
    relative_residual: f64,
}

/// `X c = y` by the factors `Q R` of X with columns of length one; X is rows times coefficients. `None` if no coefficient appears.
fn solve(
    coefficients: &Coefficients,
    model: &Model,
    rows: &[PrintedRow],
    recordings: &[&Recording],
) -> Result<Option<Found>, RegressionError> {
    let columns: Vec<usize> = (0..coefficients.parameters.len())
        .filter(|&column| rows.iter().any(|row| row.regressors[column] != 0.0))
        .collect();
    if columns.is_empty() {
        return Ok(None);
    }
    let (count, needed) = (rows.len(), LEAST_SAMPLES * columns.len());
    if count < needed {
        let (source_name, parameters) = (sources(recordings), columns.len());
        return Err(RegressionError::TooFewRows { source_name, rows: count, parameters, needed });
    }
    let matrix = DMatrix::from_fn(count, columns.len(), |r, c| rows[r].regressors[columns[c]]);
    let right = DVector::from_iterator(count, rows.iter().map(|row| row.right));
    let lengths: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
    let scaled = DMatrix::from_fn(count, columns.len(), |r, c| matrix[(r, c)] / lengths[c]);
    let factors = scaled.clone().qr();
    let unsolvable = || {
        let all = model.parameter_names();
        let names = columns.iter().map(|&column| all[coefficients.parameters[column]].clone()).collect();
        RegressionError::NotIdentifiable { source_name: sources(recordings), names }
    };
    let upper = factors.r();
    let solution = upper.solve_upper_triangular(&(factors.q().transpose() * &right)).ok_or_else(unsolvable)?;
    let inverse = (scaled.transpose() * &scaled).cholesky().ok_or_else(unsolvable)?.inverse();
    let residual = &right - &scaled * &solution;
    let (scores, follows) = scores(rows, &scaled, &residual);
    let freedom = count as f64 / (count - columns.len()) as f64;
    let of_scaled = newey_west(&scores, &follows, &inverse, CORRELATED) * freedom;
    let (values, slopes): (Vec<f64>, Vec<f64>) = columns
        .iter()
        .enumerate()
        .map(|(place, &column)| {
            let coefficient = solution[place] / lengths[place];
            match coefficients.kinds[column] {
                Kind::Reciprocal => (1.0 / coefficient, -1.0 / (coefficient * coefficient * lengths[place])),
                Kind::Linear | Kind::Shape => (coefficient, 1.0 / lengths[place]),
            }
        })
        .unzip();
    let covariance = DMatrix::from_fn(columns.len(), columns.len(), |r, c| of_scaled[(r, c)] * slopes[r] * slopes[c]);
    let (unscaled, scaled_condition) = condition_numbers(&matrix);
    Ok(Some(Found {
        columns,
        values,
        covariance,
        conditions: [unscaled, scaled_condition],
        relative_residual: residual.norm() / right.norm(),
    }))
}

/// Regressors times residual, summed over the equations of each moment in the order of time, and whether each moment follows the
/// one before without a gap.
fn scores(rows: &[PrintedRow], scaled: &DMatrix<f64>, residual: &DVector<f64>) -> (DMatrix<f64>, Vec<bool>) {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|&row| rows[row].moment);
    let mut moments: Vec<(usize, usize)> = order.iter().map(|&row| rows[row].moment).collect();
    moments.dedup();
    let mut scores = DMatrix::<f64>::zeros(moments.len(), scaled.ncols());
    let mut place = 0;
    for &row in &order {
        if rows[row].moment != moments[place] {
            place += 1;
        }
        for column in 0..scaled.ncols() {
            scores[(place, column)] += scaled[(row, column)] * residual[row];
        }
    }
    let follows = (0..moments.len()).map(|place| {
        let (recording, sample) = moments[place];
        place == 0 || moments[place - 1] == (recording, sample.wrapping_sub(1))
    });
    (scores, follows.collect())
}
