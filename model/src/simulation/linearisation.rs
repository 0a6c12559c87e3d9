//! Derivatives of the equations of motion with respect to states and parameters.

use nalgebra::DMatrix;

use crate::equations::{Inputs, OwnRows, Reach, System, Workspace};
use crate::scalar::{DIRECTIONS, Dual, constant, derivative, variable};

/// Jacobians of the rates at one instant, exact to rounding (forward dual numbers).
#[derive(Debug, Clone)]
pub struct Linearisation<'m> {
    /// Rates f, in the order of the layout.
    pub rates: Vec<f64>,
    /// df/dx, states by states.
    pub by_state: DMatrix<f64>,
    /// df/dp, states by the requested parameters.
    pub by_parameter: DMatrix<f64>,
    /// Parameters that need an evaluation of the whole model, with their columns.
    far_reaching: Vec<(usize, usize)>,
    own_rows: OwnRows<'m>,
    workspace: Workspace<'m, Dual>,
    dual_state: Vec<Dual>,
    dual_parameters: Vec<Dual>,
    dual_inputs: Inputs<Dual>,
    dual_rates: Vec<Dual>,
}

impl<'m> Linearisation<'m> {
    /// Memory for linearisations of `system` with respect to its states and the parameters with these indices.
    pub fn new(system: &System<'m>, parameters_wanted: &[usize]) -> Self {
        let states = system.layout().len;
        let columns = |reach: Reach| -> Vec<(usize, usize)> {
            let each = parameters_wanted.iter().enumerate().map(|(column, &parameter)| (parameter, column));
            each.filter(|&(parameter, _)| system.reach(parameter) == reach).collect()
        };
        let zero = constant(0.0);
        Linearisation {
            rates: vec![0.0; states],
            by_state: DMatrix::zeros(states, states),
            by_parameter: DMatrix::zeros(states, parameters_wanted.len()),
            far_reaching: columns(Reach::Others),
            own_rows: OwnRows::new(system, &columns(Reach::OwnRows)),
            workspace: system.workspace(),
            dual_state: vec![zero; states],
            dual_parameters: vec![zero; system.model().parameters().count()],
            dual_inputs: Inputs::zero(system.layout().joints),
            dual_rates: vec![zero; states],
        }
    }

    /// Evaluates rates and both Jacobians.
    pub fn evaluate(&mut self, system: &System<'m>, parameters: &[f64], state: &[f64], inputs: &Inputs<f64>) {
        self.dual_inputs.lift_from(inputs);
        let states = state.len();
        let directions = states + self.far_reaching.len();
        let mut first = 0;
        while first < directions {
            let last = (first + DIRECTIONS).min(directions);
            for (slot, &value) in self.dual_parameters.iter_mut().zip(parameters) {
                *slot = constant(value);
            }
            for (slot, &value) in self.dual_state.iter_mut().zip(state) {
                *slot = constant(value);
            }
            for direction in first..last {
                if let Some(&value) = state.get(direction) {
                    self.dual_state[direction] = variable(value, direction - first);
                } else {
                    let (parameter, _) = self.far_reaching[direction - states];
                    self.dual_parameters[parameter] = variable(parameters[parameter], direction - first);
                }
            }
            system.rates(
                &mut self.workspace,
                &self.dual_parameters,
                &self.dual_state,
                &self.dual_inputs,
                &mut self.dual_rates,
            );
            for direction in first..last {
                let mut column = if direction < states {
                    self.by_state.column_mut(direction)
                } else {
                    self.by_parameter.column_mut(self.far_reaching[direction - states].1)
                };
                for (slot, rate) in column.iter_mut().zip(&self.dual_rates) {
                    *slot = derivative(rate, direction - first);
                }
            }
            first = last;
        }
        for (slot, rate) in self.rates.iter_mut().zip(&self.dual_rates) {
            *slot = rate.re;
        }
        self.own_rows.evaluate(system, parameters, state, &self.workspace, &mut self.by_parameter);
    }
}
