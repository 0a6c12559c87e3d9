//! Solves one round of the weak form: parameters and their covariance from rows and instruments.

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::equation::EquationKind;
use super::error::sources;
use super::solution::{ConditionNumber, condition_numbers};
use super::weak_covariance::{STRETCH, jackknife};
use super::weak_rows::Row;
use super::{EquationGauge, Regression, RegressionError, WeakFormSettings};
use crate::fit::ParameterPriors;

/// Solves for the parameters that fit the rows best, with instruments.
///
/// With n rows and p parameters that appear in them, X (n x p) holds the regressors by coefficient, Z (n x p) the instruments and
/// r (n) the residuals at the present values. Every row has unit noise and the trust in its equation, every column of X and Z length
/// one. L (p x p, diagonal) and g (p) are information and gradient of the priors. The step of the coefficients is
///
/// ```text
/// d = -(Z^T X + L)^-1 (Z^T r + g)
/// ```
pub(super) fn solve(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    unknown: &[usize],
    rows: &[Row],
    with_errors: bool,
) -> Result<Regression, RegressionError> {
    let seen: Vec<usize> =
        (0..unknown.len()).filter(|&column| rows.iter().any(|row| row.regressors[column] != 0.0)).collect();
    check_rows(model, recordings, settings, rows.len(), seen.len())?;
    let gauges = gauges(model, rows);
    let columns = Columns::of(model, unknown, &seen);
    let priors = ParameterPriors::of(model, &columns.parameters, recordings, 0);
    let system = WeakSystem::new(&columns, &seen, rows, &gauges);
    let step = system.step(model, &columns, &priors, recordings)?;
    let remaining = &system.residuals + &system.regressors * &step;
    let values = columns.moved(model, &step, &system.lengths, &priors);
    let mut improved = model.clone();
    improved.set_parameter_values(&values);

    let count = seen.len();
    let (of_coefficients, quantiles) = if with_errors {
        let stretch = STRETCH * model.machine.size().time();
        let spread = jackknife(rows, &system.instruments, &system.regressors, &remaining, stretch);
        (spread.covariance, spread.quantiles)
    } else {
        (DMatrix::from_element(count, count, f64::NAN), DVector::from_element(count, f64::NAN))
    };
    let scale: Vec<f64> = (0..count).map(|column| columns.slope(column, &values) / system.lengths[column]).collect();
    let covariance = DMatrix::from_fn(count, count, |r, c| of_coefficients[(r, c)] * scale[r] * scale[c]);
    for (index, parameter) in improved.parameters_mut().enumerate() {
        if let Some(column) = columns.parameters.iter().position(|&one| one == index) {
            let variance = covariance[(column, column)];
            parameter.standard_error = variance.is_finite().then(|| variance.max(0.0).sqrt());
            parameter.margin_95 = parameter.standard_error.map(|error| quantiles[column] * error);
            parameter.source = "identified".into();
        }
    }
    let reason = "no equation that contains it has all its signals measured, with motion";
    let unseen = (0..unknown.len()).filter(|index| !seen.contains(index));
    let condition_numbers = if with_errors { group_conditions(rows, &seen, &columns.slopes) } else { Vec::new() };
    Ok(Regression {
        model: improved,
        not_identified: unseen.map(|index| (unknown[index], reason.to_string())).collect(),
        fitted: columns.parameters,
        covariance,
        condition_numbers,
        rows: rows.len(),
        equations: gauges.into_iter().map(|(_, gauge)| gauge).collect(),
    })
}

/// Whether there are rows for this number of parameters. Neighbouring windows overlap, so rows are not independent.
fn check_rows(
    model: &Model,
    recordings: &[&Recording],
    settings: &WeakFormSettings,
    rows: usize,
    parameters: usize,
) -> Result<(), RegressionError> {
    let source_name = sources(recordings);
    if parameters == 0 {
        let machine = model.machine.name.clone();
        let missing =
            "check which of displacement, pressures, opening and force are measured, and that the arm moves".into();
        return Err(RegressionError::NoEquation { source_name, machine, missing });
    }
    let (half_width, step_width) = settings.widths(model, recordings);
    let independent = rows as f64 * step_width / (2.0 * half_width);
    if independent < parameters as f64 * 2.0 {
        let needed = (parameters as f64 * 4.0 * half_width / step_width) as usize;
        return Err(RegressionError::TooFewRows { source_name, rows, parameters, needed });
    }
    Ok(())
}

/// The parameters that appear in the rows. The regression solves for coefficients, which are one over the parameter if rows are
/// linear in that.
struct Columns {
    /// Indices of the parameters in the model.
    parameters: Vec<usize>,
    kinds: Vec<Kind>,
    /// Change of the parameter per change of its coefficient, at the present values.
    slopes: Vec<f64>,
}

impl Columns {
    fn of(model: &Model, unknown: &[usize], seen: &[usize]) -> Self {
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| &*parameter.card).collect();
        let parameters: Vec<usize> = seen.iter().map(|&index| unknown[index]).collect();
        let kinds = parameters.iter().map(|&parameter| cards[parameter].kind).collect();
        let mut columns = Columns { parameters, kinds, slopes: Vec::new() };
        let values = model.parameter_values();
        columns.slopes = (0..seen.len()).map(|column| columns.slope(column, &values)).collect();
        columns
    }

    fn slope(&self, column: usize, values: &[f64]) -> f64 {
        let value = values[self.parameters[column]];
        match self.kinds[column] {
            Kind::Reciprocal => -value * value,
            Kind::Linear | Kind::Shape => 1.0,
        }
    }

    /// Parameter values after a step of the coefficients, within their bounds.
    fn moved(&self, model: &Model, step: &DVector<f64>, lengths: &[f64], priors: &ParameterPriors) -> Vec<f64> {
        let mut values = model.parameter_values();
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| &*parameter.card).collect();
        for (column, &parameter) in self.parameters.iter().enumerate() {
            let change = step[column] / lengths[column];
            let value = &mut values[parameter];
            *value = match self.kinds[column] {
                Kind::Reciprocal => {
                    let [least, most] = [cards[parameter].minimum, cards[parameter].maximum];
                    1.0 / (1.0 / *value + change).clamp(1.0 / most, 1.0 / least)
                }
                // A mass of zero or less cannot be simulated; friction and leakage may pass through zero on the way.
                Kind::Linear if cards[parameter].minimum > 0.0 => (*value + change).max(cards[parameter].minimum),
                Kind::Linear => *value + change,
                Kind::Shape => (*value + change).clamp(priors.bounds[parameter][0], priors.bounds[parameter][1]),
            };
        }
        values
    }
}

/// X, Z and r of [`solve`].
struct WeakSystem {
    regressors: DMatrix<f64>,
    instruments: DMatrix<f64>,
    residuals: DVector<f64>,
    /// Lengths of the columns of X and of Z before they were scaled.
    lengths: Vec<f64>,
    own_lengths: Vec<f64>,
}

impl WeakSystem {
    fn new(columns: &Columns, seen: &[usize], rows: &[Row], gauges: &[(EquationKind, EquationGauge)]) -> Self {
        // An equation with residuals larger than noise explains gets a weight according to its residuals.
        let trust = |kind: EquationKind| {
            let gauge = gauges.iter().find(|(own, _)| *own == kind).map_or(1.0, |(_, gauge)| gauge.chi_squared_per_row);
            1.0 / gauge.max(1.0).sqrt()
        };
        let mut regressors = DMatrix::zeros(rows.len(), seen.len());
        let mut instruments = DMatrix::zeros(rows.len(), seen.len());
        let mut residuals = DVector::zeros(rows.len());
        for (number, row) in rows.iter().enumerate() {
            let trust = trust(row.kind);
            residuals[number] = row.residual * trust;
            for (column, &index) in seen.iter().enumerate() {
                let factor = columns.slopes[column] * trust;
                regressors[(number, column)] = row.regressors[index] * factor;
                instruments[(number, column)] = row.instruments[index] * factor;
            }
        }
        let lengths: Vec<f64> = regressors.column_iter().map(|column| column.norm()).collect();
        let own_lengths: Vec<f64> = instruments.column_iter().map(|column| column.norm()).collect();
        for (column, (&length, &own)) in lengths.iter().zip(&own_lengths).enumerate() {
            regressors.column_mut(column).scale_mut(1.0 / length);
            instruments.column_mut(column).scale_mut(if own > 0.0 { 1.0 / own } else { 0.0 });
        }
        WeakSystem { regressors, instruments, residuals, lengths, own_lengths }
    }

    /// The step of the coefficients, in units of the columns of X.
    fn step(
        &self,
        model: &Model,
        columns: &Columns,
        priors: &ParameterPriors,
        recordings: &[&Recording],
    ) -> Result<DVector<f64>, RegressionError> {
        let mut matrix = self.instruments.transpose() * &self.regressors;
        let mut right = self.instruments.transpose() * &self.residuals;
        // The prior of each nuisance parameter counts as one more row.
        let equations = priors.equations(&model.parameter_values(), &vec![1.0; columns.parameters.len()]);
        for (column, (information, gradient)) in equations.into_iter().enumerate() {
            let scale = 1.0 / self.lengths[column];
            let instrument_scale = if self.own_lengths[column] > 0.0 { 1.0 / self.own_lengths[column] } else { scale };
            matrix[(column, column)] += information * scale * instrument_scale;
            right[column] -= gradient * instrument_scale;
        }
        let names = model.parameter_names();
        let not_identifiable = |involved: &[usize]| RegressionError::NotIdentifiable {
            source_name: sources(recordings),
            names: involved.iter().map(|&column| names[columns.parameters[column]].clone()).collect(),
        };
        let all: Vec<usize> = (0..columns.parameters.len()).collect();
        // The iterations are bounded: on a matrix with a NaN the plain decomposition never ends.
        let svd = matrix.clone().try_svd(true, true, f64::EPSILON, 10_000).ok_or_else(|| not_identifiable(&all))?;
        if svd.singular_values.min() < 1e-9 * svd.singular_values.max() {
            let weakest = svd.singular_values.imin();
            let involved = svd.v_t.as_ref().map_or(Vec::new(), |v_t| {
                let row = v_t.row(weakest);
                let largest = row.amax();
                all.iter().copied().filter(|&column| row[column].abs() > 0.3 * largest).collect()
            });
            return Err(not_identifiable(&involved));
        }
        let inverse = matrix.try_inverse().ok_or_else(|| not_identifiable(&all))?;
        Ok(-(&inverse * right))
    }
}

/// How well the equations of the rows are met, in the order of their kinds.
fn gauges(model: &Model, rows: &[Row]) -> Vec<(EquationKind, EquationGauge)> {
    let mut kinds: Vec<EquationKind> = rows.iter().map(|row| row.kind).collect();
    kinds.sort();
    kinds.dedup();
    let gauge = |kind: EquationKind| {
        let own: Vec<&Row> = rows.iter().filter(|row| row.kind == kind).collect();
        let count = own.len() as f64;
        let gauge = EquationGauge {
            equation: kind.name(model),
            chi_squared_per_row: own.iter().map(|row| row.residual * row.residual).sum::<f64>() / count,
            relative_residual: (own.iter().map(|row| row.relative * row.relative).sum::<f64>() / count).sqrt(),
            rows: own.len(),
        };
        (kind, gauge)
    };
    kinds.into_iter().map(gauge).collect()
}

/// Condition numbers of the mechanical and the hydraulic regressors, as \[A\] Section 3.2 reports them.
fn group_conditions(rows: &[Row], seen: &[usize], slopes: &[f64]) -> Vec<ConditionNumber> {
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
                (0..seen.len()).filter(|&c| own.iter().any(|row| row.regressors[seen[c]] != 0.0)).collect();
            if own.is_empty() || columns.is_empty() {
                return None;
            }
            let matrix = DMatrix::from_fn(own.len(), columns.len(), |r, c| {
                own[r].regressors[seen[columns[c]]] * own[r].noise * slopes[columns[c]]
            });
            let (unscaled, scaled) = condition_numbers(&matrix);
            Some(ConditionNumber { group, unscaled, scaled })
        })
        .collect()
}
