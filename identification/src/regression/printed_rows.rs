//! The equations as \[A\] prints them, one row for each sample: first differences, moving averages, measured pressures.

use excavator_model::Model;
use excavator_model::effects::Kind;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::DVector;

use super::equation::{Equation, EquationKind, equations_by};
use super::{Observation, RegressionError, observe};

/// Length of the moving average, samples (\[A\] Section 3.1: "43-order").
pub(super) const MOVING_AVERAGE: usize = 43;

/// One sample of one equation.
pub(super) struct PrintedRow {
    /// Number of the recording, and of the sample in it.
    pub moment: (usize, usize),
    /// Regressor of each coefficient.
    pub regressors: DVector<f64>,
    /// Right-hand side.
    pub right: f64,
}

/// The coefficients that rows are linear in: one over the parameter if that is its kind.
pub(super) struct Coefficients {
    /// Indices of their parameters.
    pub parameters: Vec<usize>,
    pub kinds: Vec<Kind>,
}

impl Coefficients {
    /// The unknown parameters of `model` that its equations are linear in.
    pub fn of(model: &Model) -> Self {
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| &*parameter.card).collect();
        let parameters: Vec<usize> =
            model.unknown_parameters().into_iter().filter(|&index| cards[index].kind != Kind::Shape).collect();
        let kinds = parameters.iter().map(|&index| cards[index].kind).collect();
        Coefficients { parameters, kinds }
    }

    /// Rows of the mechanical and of the hydraulic equations, \[A\] Eq. 6 and 7.
    ///
    /// # Errors
    /// [`RegressionError`] if the recordings lack the model's inputs.
    pub fn rows(
        &self,
        model: &Model,
        recordings: &[&Recording],
    ) -> Result<[(&'static str, Vec<PrintedRow>); 2], RegressionError> {
        let values = model.parameter_values();
        let system = System::new(model).as_printed();
        let mut groups: [(&'static str, Vec<PrintedRow>); 2] = [("mechanical", vec![]), ("hydraulic", vec![])];
        for (number, recording) in recordings.iter().enumerate() {
            let observation = averaged(model, recording, observe(model, recording)?);
            let effect_states = vec![Vec::new(); recording.len()];
            for equation in equations_by(&system, &observation, &effect_states, &self.parameters, &[]) {
                let group = usize::from(!matches!(equation.kind, EquationKind::Motion(_)));
                for (sample, mut regressors, residual) in samples(&equation, &observation.time, self.parameters.len()) {
                    let mut known = 0.0;
                    for (c, (&index, kind)) in self.parameters.iter().zip(&self.kinds).enumerate() {
                        let (slope, coefficient) = match kind {
                            Kind::Reciprocal => (-values[index] * values[index], 1.0 / values[index]),
                            Kind::Linear | Kind::Shape => (1.0, values[index]),
                        };
                        regressors[c] *= slope;
                        known += regressors[c] * coefficient;
                    }
                    // Rows are linear in the coefficients, so the residual at zero coefficients is the right-hand side.
                    groups[group].1.push(PrintedRow { moment: (number, sample), regressors, right: known - residual });
                }
            }
        }
        Ok(groups)
    }
}

/// Sample, regressors and residual of an equation wherever all signals are measured.
fn samples(equation: &Equation, time: &[f64], parameters: usize) -> Vec<(usize, DVector<f64>, f64)> {
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
            let whole = residual.is_finite() && regressors.iter().all(|value| value.is_finite());
            whole.then_some((sample, regressors, residual))
        })
        .collect()
}

/// The observation smoothed as in the paper: derivatives are averages, all other signals are readings.
fn averaged(model: &Model, recording: &Recording, mut observation: Observation) -> Observation {
    observation.inputs = observation.inputs.with_readings(model, recording);
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
