//! Derivatives of the rates by parameters that reach no further than their effect's own rows.
//!
//! Most effects add to the rows of the equations and leave what others see as it is. What such a parameter changes follows from its effect
//! alone, with all else held: a fraction of an evaluation of the whole model.

use nalgebra::DMatrix;

use super::{System, Workspace};
use crate::effects::ActsOn;
use crate::scalar::{DIRECTIONS, Dual, constant, derivative, variable};

/// How far a parameter reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// Not to the rates: it is an instrument's.
    Instruments,
    /// To what its effect adds to the rows, and to its effect's memory.
    OwnRows,
    /// To what other effects see.
    Others,
}

impl System<'_> {
    /// How far the parameter with this index reaches.
    pub fn reach(&self, parameter: usize) -> Reach {
        let Some(owner) = self.owner(parameter) else { return Reach::Others };
        let effect = &self.model().effects[owner].physics;
        let feeds_others = self.reads_metering_flows() && effect.card().acts_on == ActsOn::Valve;
        let is_imposed = self.layout().rod_forces.is_some();
        if effect.adjusts_others() || effect.reads_course() || feeds_others || is_imposed {
            Reach::Others
        } else if effect.is_an_instruments() {
            Reach::Instruments
        } else {
            Reach::OwnRows
        }
    }
}

/// Memory for the derivatives by some parameters of [`Reach::OwnRows`].
#[derive(Debug, Clone)]
pub struct OwnRows<'m> {
    passes: Vec<Pass>,
    /// The model with all held but the parameters of the present pass.
    held: Workspace<'m, Dual>,
    parameters: Vec<Dual>,
    state: Vec<Dual>,
    rates: Vec<Dual>,
}

/// Parameters whose derivatives fit into one dual number.
#[derive(Debug, Clone)]
struct Pass {
    /// Index in the model, and column of the result.
    parameters: Vec<(usize, usize)>,
    /// Their effects.
    effects: Vec<usize>,
}

impl<'m> OwnRows<'m> {
    /// For parameters given by their index in the model and the column that they have in the result.
    pub fn new(system: &System<'m>, wanted: &[(usize, usize)]) -> Self {
        let passes = wanted.chunks(DIRECTIONS).map(|parameters| {
            let mut effects: Vec<usize> =
                parameters.iter().filter_map(|&(parameter, _)| system.owner(parameter)).collect();
            effects.dedup();
            Pass { parameters: parameters.to_vec(), effects }
        });
        let zero = constant(0.0);
        OwnRows {
            passes: passes.collect(),
            held: system.workspace(),
            parameters: vec![zero; system.model().parameters().count()],
            state: vec![zero; system.layout().len],
            rates: vec![zero; system.layout().len],
        }
    }

    /// Writes the derivatives into their columns of `by_parameter`. `now` is the workspace of an evaluation of the rates at these
    /// parameters and this state; its derivatives do not matter.
    pub fn evaluate(
        &mut self,
        system: &System<'m>,
        parameters: &[f64],
        state: &[f64],
        now: &Workspace<'m, Dual>,
        by_parameter: &mut DMatrix<f64>,
    ) {
        if self.passes.is_empty() {
            return;
        }
        self.held.situation.hold(&now.situation);
        for (slot, &value) in self.parameters.iter_mut().zip(parameters) {
            *slot = constant(value);
        }
        for (slot, &value) in self.state.iter_mut().zip(state) {
            *slot = constant(value);
        }
        for pass in &self.passes {
            for (direction, &(parameter, _)) in pass.parameters.iter().enumerate() {
                self.parameters[parameter] = variable(parameters[parameter], direction);
            }
            self.rates.fill(constant(0.0));
            self.held.rows.clear();
            for &effect in &pass.effects {
                system.contribute_one(effect, &mut self.held, &self.parameters, &self.state);
                system.remember_one(effect, &self.held, &self.parameters, &self.state, &mut self.rates);
            }
            self.held.rows.set_values(&now.rows);
            system.assemble(&mut self.held, &mut self.rates);
            for (direction, &(parameter, column)) in pass.parameters.iter().enumerate() {
                for (slot, rate) in by_parameter.column_mut(column).iter_mut().zip(&self.rates) {
                    *slot = derivative(rate, direction);
                }
                self.parameters[parameter] = constant(parameters[parameter]);
            }
        }
    }
}
