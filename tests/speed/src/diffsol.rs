//! The same model solved by `diffsol`, an independent solver with its own error control.
use std::cell::RefCell;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use excavator_model::Model;
use excavator_model::equations::{Inputs, System};
use excavator_model::simulation::{InputSignals, Linearisation};

/// Which of diffsol's stiff solvers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Backward differences of variable order.
    Bdf,
    /// Two-stage singly diagonally implicit Runge-Kutta of second order.
    TrBdf2,
    /// Four-stage singly diagonally implicit Runge-Kutta of third order.
    Esdirk34,
}

/// States of `model` at the samples of evenly spaced `signals`, from `start`. `relative` is diffsol's relative tolerance, the
/// absolute ones are it times 0.01 rad, 0.1 rad/s, 1 MPa and 1e-5 m².
///
/// # Errors
/// Diffsol's words, when it gives up.
pub fn solve(
    model: &Model,
    signals: &InputSignals,
    start: &[f64],
    method: Method,
    relative: f64,
) -> Result<Vec<Vec<f64>>, String> {
    let times = &signals.time;
    let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let inputs_at = |time: f64, inputs: &mut Inputs<f64>| {
        let index = ((time / interval) as usize).min(signals.len() - 2);
        signals.between(index, ((time - times[index]) / interval).clamp(0.0, 1.0), inputs);
    };
    let system = System::new(model);
    let layout = system.layout().clone();
    let parameters = model.parameter_values();
    let memory = RefCell::new((
        system.workspace::<f64>(),
        Inputs::<f64>::zero(layout.joints),
        Linearisation::new(&system, &[]),
        // Where the Jacobian was evaluated last: diffsol asks for it column by column.
        (f64::NAN, vec![f64::NAN; layout.len]),
    ));
    let rates = |state: &[f64], _: &[f64], time: f64, rates: &mut [f64]| {
        let (workspace, inputs, _, _) = &mut *memory.borrow_mut();
        inputs_at(time, inputs);
        system.rates(workspace, &parameters, state, inputs, rates);
    };
    let jacobian = |state: &[f64], _: &[f64], time: f64, direction: &[f64], product: &mut [f64]| {
        let (_, inputs, linearisation, (last_time, last_state)) = &mut *memory.borrow_mut();
        if *last_time != time || last_state != state {
            inputs_at(time, inputs);
            linearisation.evaluate(&system, &parameters, state, inputs);
            *last_time = time;
            last_state.copy_from_slice(state);
        }
        for (row, slot) in product.iter_mut().enumerate() {
            *slot = (0..direction.len()).map(|column| linearisation.by_state[(row, column)] * direction[column]).sum();
        }
    };
    let mut absolute = vec![1e6 * relative; layout.len];
    absolute[..layout.joints].fill(0.01 * relative);
    absolute[layout.joints..2 * layout.joints].fill(0.1 * relative);
    for &(first, states) in &layout.effect_states {
        absolute[first..first + states].fill(1e-5 * relative);
    }
    let mut problem = OdeBuilder::<NalgebraMat<f64>>::new()
        .rtol(relative)
        .atol(absolute)
        .h0(1e-6)
        .rhs_implicit(rates, jacobian)
        .init(|_: &[f64], _: f64, state: &mut [f64]| state.copy_from_slice(start), layout.len)
        .build()
        .map_err(|error| error.to_string())?;
    // diffsol counts these over the whole trajectory and gives up after 50; each corner of the physics costs a few.
    problem.ode_options.max_nonlinear_solver_failures = 1_000_000;
    problem.ode_options.max_error_test_failures = 1_000_000;
    let (values, _) = match method {
        Method::Bdf => problem.bdf::<NalgebraLU<f64>>().and_then(|mut solver| solver.solve_dense(times)),
        Method::TrBdf2 => problem.tr_bdf2::<NalgebraLU<f64>>().and_then(|mut solver| solver.solve_dense(times)),
        Method::Esdirk34 => problem.esdirk34::<NalgebraLU<f64>>().and_then(|mut solver| solver.solve_dense(times)),
    }
    .map_err(|error| error.to_string())?;
    Ok((0..times.len()).map(|column| (0..layout.len).map(|row| values[(row, column)]).collect()).collect())
}
