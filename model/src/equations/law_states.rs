//! Estimates states of laws with memory from measured signals.
//!
//! No sensor measures the bending of a bristle. If all other states are known, its state follows from its rate.

use super::{Inputs, System, Workspace};

/// States of laws, propagated from sample to sample.
#[derive(Debug, Clone)]
pub struct LawStates<'m> {
    workspace: Workspace<'m, f64>,
    /// Time of the last known states, s, and their values.
    known: Option<(f64, Vec<f64>)>,
}

/// Length of a gap after which memory restarts, s: longer than the memory of any seal.
const GAP: f64 = 0.5;

/// Step of the finite difference of a state's rate, as a fraction of the state's order of magnitude.
const NUDGE: f64 = 1e-4;

impl<'m> LawStates<'m> {
    /// No states known yet.
    pub fn new(system: &System<'m>) -> Self {
        LawStates { workspace: system.workspace(), known: None }
    }

    /// Sets the effects' own states in `state`, whose other entries are measured at `time` (s). Spools are set as by
    /// [`System::set_effect_states`]. States of laws take one step from the last call (Rosenbrock-Euler, which is stable for any
    /// rate of decay). `parameters` are the model's. If time does not increase, laws restart.
    pub fn follow(
        &mut self,
        system: &System<'m>,
        parameters: &[f64],
        time: f64,
        inputs: &Inputs<f64>,
        state: &mut [f64],
    ) {
        if !system.has_effect_states() {
            return;
        }
        system.set_effect_states(&inputs.orifice_area, state);
        let own: Vec<(usize, f64)> = system.law_states().collect();
        if own.is_empty() {
            return;
        }
        if let Some((before, values)) = &self.known
            && (0.0..GAP * system.model().machine.size().time()).contains(&(time - before))
        {
            let step = time - before;
            for ((index, _), value) in own.iter().zip(values) {
                state[*index] = *value;
            }
            let rates = self.rates(system, parameters, inputs, state);
            let next: Vec<f64> = own
                .iter()
                .map(|&(index, scale)| {
                    let (here, nudge) = (state[index], NUDGE * scale);
                    state[index] = here + nudge;
                    let slope = (self.rates(system, parameters, inputs, state)[index] - rates[index]) / nudge;
                    state[index] = here;
                    // An unstable law would make the step infinite.
                    here + step * rates[index] / (1.0 - step * slope.min(0.0))
                })
                .collect();
            for ((index, _), value) in own.iter().zip(&next) {
                state[*index] = *value;
            }
        }
        let values: Vec<f64> = own.iter().map(|(index, _)| state[*index]).collect();
        // Missing measurements leave the memory unchanged.
        if values.iter().all(|value| value.is_finite()) {
            self.known = Some((time, values));
        }
    }

    fn rates(&mut self, system: &System<'m>, parameters: &[f64], inputs: &Inputs<f64>, state: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; state.len()];
        system.rates(&mut self.workspace, parameters, state, inputs, &mut rates);
        rates
    }
}
