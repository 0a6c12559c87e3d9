//! The classical explicit Runge-Kutta scheme of fourth order, at a step that resolves everything.

use super::{Plant, STATES, State};

/// Step, s. The stiffest pressure (closed rod side, laminar edge) moves with about 4e4/s; the scheme is stable to
/// 2.78/4e4 = 70 us.
pub const STEP: f64 = 25e-6;

/// One step of [`STEP`] from `time` (s).
pub fn step(plant: &Plant, time: f64, state: &mut State, command: f64, late_command: f64) {
    plant.settle(state, command);
    let rates = |time: f64, state: &State| plant.rates(time, state, command, late_command);
    let moved = |slope: &[f64; STATES], by: f64| {
        let mut next = *state;
        next.values.iter_mut().zip(slope).for_each(|(value, slope)| *value += by * slope);
        next
    };
    let first = rates(time, state);
    let second = rates(time + STEP / 2.0, &moved(&first, STEP / 2.0));
    let third = rates(time + STEP / 2.0, &moved(&second, STEP / 2.0));
    let fourth = rates(time + STEP, &moved(&third, STEP));
    for (index, value) in state.values.iter_mut().enumerate() {
        *value += STEP / 6.0 * (first[index] + 2.0 * second[index] + 2.0 * third[index] + fourth[index]);
    }
    plant.settle(state, command);
}
