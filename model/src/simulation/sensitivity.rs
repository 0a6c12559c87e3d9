//! How a trajectory depends on parameters and initial states.

use nalgebra::DMatrix;

use super::Linearisation;
use crate::equations::System;
use crate::scalar::{constant, derivative, variable};

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
        let states = self.matrix.nrows();
        let identity_minus = |jacobian: DMatrix<f64>| {
            let mut matrix = jacobian * -weight;
            for state in 0..states {
                matrix[(state, state)] += 1.0;
            }
            matrix.lu()
        };
        let middle_by_state = &self.start_by_state * (1.0 - MIDDLE) + &linearisation.by_state * MIDDLE;
        let mut middle = &self.matrix + &self.start_by_state * &self.matrix * weight;
        for column in 0..self.parameters {
            for state in 0..states {
                let start = self.start_by_parameter[(state, column)];
                let end = linearisation.by_parameter[(state, column)];
                middle[(state, column)] += weight * (start * (2.0 - MIDDLE) + end * MIDDLE);
            }
        }
        identity_minus(middle_by_state).solve_mut(&mut middle);
        let normal = 1.0 / (MIDDLE * (2.0 - MIDDLE));
        let old = (1.0 - MIDDLE) * (1.0 - MIDDLE) * normal;
        middle *= normal;
        self.matrix *= -old;
        self.matrix += middle;
        for column in 0..self.parameters {
            for state in 0..states {
                self.matrix[(state, column)] += weight * linearisation.by_parameter[(state, column)];
            }
        }
        identity_minus(linearisation.by_state.clone()).solve_mut(&mut self.matrix);
    }
}

/// Sensitivity of what instruments see, from the sensitivity of states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputSensitivity {
    /// d(displacement)/dq, m/rad.
    pub displacement_by_joint: f64,
    /// d(velocity)/dq, 1/s per rad times m.
    pub velocity_by_joint: f64,
    /// d(velocity)/d(rate), m/rad.
    pub velocity_by_rate: f64,
}

impl OutputSensitivity {
    /// For one cylinder at a state.
    pub fn of(system: &System<'_>, cylinder: usize, state: &[f64]) -> Self {
        let layout = system.layout();
        let linkage = &system.model().machine.cylinders[cylinder].linkage;
        let joint = variable(state[layout.joint(cylinder)], 0);
        let rate = state[layout.rate(cylinder)];
        let lever = linkage.lever(joint);
        let velocity = lever * constant(rate);
        OutputSensitivity {
            displacement_by_joint: derivative(&linkage.displacement(joint), 0),
            velocity_by_joint: derivative(&velocity, 0),
            velocity_by_rate: lever.re,
        }
    }
}
