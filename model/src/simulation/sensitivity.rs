//! Sensitivities of a trajectory to parameters and initial states.

use super::Linearisation;
use super::factors::Factors;
use crate::equations::{Reach, System};

/// Forward sensitivities `S = dx/d(parameters, initial states)`, carried along a trajectory.
///
/// `dS/dt = df/dx S + df/dp` is linear. TR-BDF2 (second order, L-stable) integrates it with the Jacobians at both ends of each
/// step and linear interpolation between them. Sensitivities direct a search and enter standard errors, so a relative error of
/// 1e-3 is sufficient.
#[derive(Debug, Clone)]
pub struct Sensitivity {
    /// Columns of the requested parameters, then of the initial states, that can be non-zero; those of instruments cannot.
    columns: Vec<usize>,
    /// Number of columns.
    width: usize,
    /// Number of `columns` that belong to parameters.
    acting: usize,
    states: usize,
    /// The sensitivities, row-major, so that one row operation covers all columns.
    values: Vec<f64>,
    /// The stage being solved, likewise.
    stage: Vec<f64>,
    start_by_state: Vec<f64>,
    middle_by_state: Vec<f64>,
    /// Derivatives with respect to the acting parameters, row-major: at the start of a step, at its end.
    by_parameter: [Vec<f64>; 2],
    factors: Factors,
}

impl Sensitivity {
    /// At the start of a trajectory: zero for the parameters with these indices, one for each initial state.
    pub fn at_start(system: &System<'_>, parameters: &[usize]) -> Self {
        let states = system.layout().len;
        let acts = |&column: &usize| system.reach(parameters[column]) != Reach::Instruments;
        let mut columns: Vec<usize> = (0..parameters.len()).filter(acts).collect();
        let acting = columns.len();
        columns.extend(parameters.len()..parameters.len() + states);
        let mut values = vec![0.0; states * columns.len()];
        for state in 0..states {
            values[state * columns.len() + acting + state] = 1.0;
        }
        Sensitivity {
            width: parameters.len() + states,
            acting,
            states,
            stage: values.clone(),
            values,
            columns,
            start_by_state: vec![0.0; states * states],
            middle_by_state: vec![0.0; states * states],
            by_parameter: [vec![0.0; states * acting], vec![0.0; states * acting]],
            factors: Factors::new(states),
        }
    }

    /// Number of columns: one for each requested parameter, then one for each initial state.
    pub fn width(&self) -> usize {
        self.width
    }

    /// The columns that can be non-zero, in ascending order.
    pub fn columns(&self) -> &[usize] {
        &self.columns
    }

    /// Derivatives of one state with respect to the variables of [`Sensitivity::columns`].
    pub fn of_state(&self, state: usize) -> &[f64] {
        &self.values[state * self.columns.len()..(state + 1) * self.columns.len()]
    }

    /// Derivatives of all states with respect to the variable of one column.
    pub fn by_column(&self, column: usize) -> Vec<f64> {
        let position = self.columns.binary_search(&column);
        (0..self.states).map(|state| position.map_or(0.0, |position| self.of_state(state)[position])).collect()
    }

    /// Stores the Jacobians at the start of a step.
    pub(super) fn begin(&mut self, linearisation: &Linearisation<'_>) {
        self.start_by_state.copy_from_slice(linearisation.by_state.as_slice());
        self.note_by_parameter(linearisation, 0);
    }

    fn note_by_parameter(&mut self, linearisation: &Linearisation<'_>, end: usize) {
        for (position, &column) in self.columns[..self.acting].iter().enumerate() {
            let slopes = linearisation.by_parameter.column(column);
            let slots = self.by_parameter[end].iter_mut().skip(position).step_by(self.acting);
            slots.zip(slopes.iter()).for_each(|(slot, slope)| *slot = *slope);
        }
    }

    /// Advances the sensitivities over a step of length `step`, with the Jacobians at its end.
    pub(super) fn finish(&mut self, linearisation: &Linearisation<'_>, step: f64) {
        /// Position of the middle stage of TR-BDF2: 2 - sqrt 2 makes both stages share one coefficient.
        const MIDDLE: f64 = 2.0 - std::f64::consts::SQRT_2;
        let weight = MIDDLE / 2.0 * step;
        self.note_by_parameter(linearisation, 1);
        let (states, width, acting) = (self.states, self.columns.len(), self.acting);
        let Sensitivity { values, stage, start_by_state, middle_by_state, by_parameter, factors, .. } = self;
        let [start, end] = by_parameter;

        stage.copy_from_slice(values);
        for (row, target) in stage.chunks_exact_mut(width).enumerate() {
            for (other, values) in values.chunks_exact(width).enumerate() {
                // Column-major, as the linearisation stores it.
                let factor = weight * start_by_state[other * states + row];
                if factor != 0.0 {
                    add(target, factor, values);
                }
            }
            let own = row * acting..(row + 1) * acting;
            for (slot, (start, end)) in target.iter_mut().zip(start[own.clone()].iter().zip(&end[own])) {
                *slot += weight * (start * (2.0 - MIDDLE) + end * MIDDLE);
            }
        }
        let ends = start_by_state.iter().zip(linearisation.by_state.as_slice());
        for (slot, (start, end)) in middle_by_state.iter_mut().zip(ends) {
            *slot = start * (1.0 - MIDDLE) + end * MIDDLE;
        }
        factors.factorise(1.0, weight, middle_by_state);
        factors.solve_side_by_side(stage, width);

        let normal = 1.0 / (MIDDLE * (2.0 - MIDDLE));
        let share = (1.0 - MIDDLE) * (1.0 - MIDDLE) * normal;
        for (slot, stage) in values.iter_mut().zip(&*stage) {
            *slot = normal * stage - share * *slot;
        }
        for (row, target) in values.chunks_exact_mut(width).enumerate() {
            for (slot, end) in target.iter_mut().zip(&end[row * acting..(row + 1) * acting]) {
                *slot += weight * end;
            }
        }
        factors.factorise(1.0, weight, linearisation.by_state.as_slice());
        factors.solve_side_by_side(values, width);
    }
}

fn add(to: &mut [f64], factor: f64, values: &[f64]) {
    for (slot, value) in to.iter_mut().zip(values) {
        *slot += factor * value;
    }
}
