//! Derivatives of the rates with respect to parameters that affect only their own effect's rows.
//!
//! Most effects add to the rows of the equations and do not change what other effects see. The derivative with respect to such a
//! parameter needs its own effect only, with everything else constant: a fraction of an evaluation of the whole model.

use nalgebra::DMatrix;

use super::{System, Workspace};
use crate::effects::ActsOn;
use crate::scalar::{DIRECTIONS, Dual, constant, derivative, variable};

/// What a parameter affects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// Instruments only, not the rates.
    Instruments,
    /// The rows and the memory of its own effect.
    OwnRows,
    /// What other effects see.
    Others,
}

impl System<'_> {
    /// What the parameter with this index affects.
    pub fn reach(&self, parameter: usize) -> Reach {
        let Some(owner) = self.owner(parameter) else { return Reach::Others };
        let effect = &self.model().effects[owner].physics;
        let feeds_others = self.reads_metering_flows() && effect.card().acts_on == ActsOn::Valve;
        let is_imposed = self.layout().rod_forces.is_some();
        if effect.adjusts_others() || effect.reads_input_rate() || feeds_others || is_imposed {
            Reach::Others
        } else if effect.is_an_instruments() {
            Reach::Instruments
        } else {
            Reach::OwnRows
        }
    }
}

/// Memory for the derivatives with respect to some parameters of [`Reach::OwnRows`].
#[derive(Debug, Clone)]
pub struct OwnRows<'m> {
    passes: Vec<Pass>,
    /// The model with everything constant except the parameters of the present pass.
    held: Workspace<'m, Dual>,
    parameters: Vec<Dual>,
    state: Vec<Dual>,
    rates: Vec<Dual>,
}

/// Parameters whose derivatives fit into one dual number.
#[derive(Debug, Clone)]
struct Pass {
    /// Index in the model, and column in the result.
    parameters: Vec<(usize, usize)>,
    /// Their effects.
    effects: Vec<usize>,
}

impl<'m> OwnRows<'m> {
    /// For parameters given by their index in the model and their column in the result.
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

    /// Writes the derivatives to their columns of `by_parameter`. `now` is the workspace of an evaluation of the rates at these
    /// parameters and this state; its derivatives are ignored.
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
