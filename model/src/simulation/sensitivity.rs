//! How a trajectory depends on parameters and initial states.

use nalgebra::DMatrix;

use super::Linearisation;
use super::factors::Factors;

/// Forward sensitivities `S = dx/d(parameters, initial states)`, carried along a trajectory.
///
/// `dS/dt = df/dx S + df/dp` is linear; it is integrated by TR-BDF2 (second order, L-stable) with the Jacobians at both
/// ends of each step and straight lines between them. Sensitivities steer a search and enter standard errors, so a
/// relative error of 1e-3 is ample.
#[derive(Debug, Clone)]
pub struct Sensitivity {
    /// dx/d(parameters, initial states), states by parameters then states.
    pub matrix: DMatrix<f64>,
    parameters: usize,
    start_by_state: DMatrix<f64>,
    start_by_parameter: DMatrix<f64>,
    middle_by_state: Vec<f64>,
    factors: Factors,
    /// The sensitivities, row-major, so that one row operation runs over all parameters and initial states at once.
    old: Vec<f64>,
    /// The stage that is being solved for, row-major.
    stage: Vec<f64>,
}

impl Sensitivity {
    /// At the start of a trajectory: zero for `parameters` parameters, one for each of `states` initial states.
    pub fn at_start(states: usize, parameters: usize) -> Self {
        let mut matrix = DMatrix::zeros(states, parameters + states);
        for state in 0..states {
            matrix[(state, parameters + state)] = 1.0;
        }
        Sensitivity {
            matrix,
            parameters,
            start_by_state: DMatrix::zeros(states, states),
            start_by_parameter: DMatrix::zeros(states, parameters),
            middle_by_state: vec![0.0; states * states],
            factors: Factors::new(states),
            old: vec![0.0; states * (parameters + states)],
            stage: vec![0.0; states * (parameters + states)],
        }
    }

    /// Notes the Jacobians at the start of a step.
    pub(super) fn begin(&mut self, linearisation: &Linearisation<'_>) {
        self.start_by_state.copy_from(&linearisation.by_state);
        self.start_by_parameter.copy_from(&linearisation.by_parameter);
    }

    /// Carries the sensitivities over a step of length `step`, with the Jacobians at its end.
    pub(super) fn finish(&mut self, linearisation: &Linearisation<'_>, step: f64) {
        /// Where TR-BDF2 puts its middle stage: 2 - sqrt 2 makes both stages share one coefficient.
        const MIDDLE: f64 = 2.0 - std::f64::consts::SQRT_2;
        let weight = MIDDLE / 2.0 * step;
        let (states, columns) = self.matrix.shape();
        let Sensitivity { matrix, start_by_state, start_by_parameter, middle_by_state, factors, old, stage, .. } = self;

        for row in 0..states {
            for column in 0..columns {
                old[row * columns + column] = matrix[(row, column)];
            }
        }
        stage.copy_from_slice(old);
        for row in 0..states {
            let target = &mut stage[row * columns..(row + 1) * columns];
            for (other, values) in old.chunks_exact(columns).enumerate() {
                let factor = weight * start_by_state[(row, other)];
                for (slot, value) in target.iter_mut().zip(values) {
                    *slot += factor * value;
                }
            }
            for (column, slot) in target[..self.parameters].iter_mut().enumerate() {
                let (start, end) = (start_by_parameter[(row, column)], linearisation.by_parameter[(row, column)]);
                *slot += weight * (start * (2.0 - MIDDLE) + end * MIDDLE);
            }
        }
        let ends = start_by_state.iter().zip(&linearisation.by_state);
        for (slot, (start, end)) in middle_by_state.iter_mut().zip(ends) {
            *slot = start * (1.0 - MIDDLE) + end * MIDDLE;
        }
        factors.factorise(1.0, weight, middle_by_state);
        factors.solve_side_by_side(stage, columns);

        let normal = 1.0 / (MIDDLE * (2.0 - MIDDLE));
        let share = (1.0 - MIDDLE) * (1.0 - MIDDLE) * normal;
        for (slot, old) in stage.iter_mut().zip(&*old) {
            *slot = normal * *slot - share * old;
        }
        for (row, target) in stage.chunks_exact_mut(columns).enumerate() {
            for (column, slot) in target[..self.parameters].iter_mut().enumerate() {
                *slot += weight * linearisation.by_parameter[(row, column)];
            }
        }
        factors.factorise(1.0, weight, linearisation.by_state.as_slice());
        factors.solve_side_by_side(stage, columns);
        for row in 0..states {
            for column in 0..columns {
                matrix[(row, column)] = stage[row * columns + column];
            }
        }
    }
}
