//! Whole simulations.

use super::{InputSignals, Integrator, SimulationError, Tolerances, initial_state};
use crate::Model;
use crate::SignalError;
use crate::equations::System;
use crate::recording::Recording;

/// Why there is no simulated recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The recording does not give what the model needs.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// The integration ended early.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Simulates `model` with the inputs of `recording` from the state measured at its start; the result has the
/// recording's clock and inputs, and simulated displacement, velocity, joint angle and pressures.
///
/// # Errors
/// [`RunError`].
pub fn simulate(model: &Model, recording: &Recording) -> Result<Recording, RunError> {
    let signals = InputSignals::from_recording(model, recording)?;
    let system = System::new(model);
    if signals.is_empty() {
        return Ok(recording.clone());
    }
    let spool: Vec<f64> = (0..model.machine.cylinders.len()).map(|c| signals.orifice_area(c)[0]).collect();
    let state = initial_state(&system, recording, 0, &spool, signals.tank_pressure()[0])?;
    Ok(simulate_from(model, recording, &signals, state, Tolerances::default())?)
}

/// Simulates from a given state (in the order of the model's layout).
///
/// # Errors
/// [`SimulationError`].
pub fn simulate_from(
    model: &Model,
    recording: &Recording,
    signals: &InputSignals,
    mut state: Vec<f64>,
    tolerances: Tolerances,
) -> Result<Recording, SimulationError> {
    let system = System::new(model);
    let mut integrator = Integrator::new(&system, &model.parameter_values(), &[], tolerances);
    let mut simulated = recording.clone();
    simulated.source = format!("{} simulated", model.machine.name);
    for index in 0..signals.len() {
        observed(&system, &state, index, &mut simulated);
        if index + 1 < signals.len() {
            integrator.advance(signals, index, &mut state, None)?;
        }
    }
    Ok(simulated)
}

/// Writes what instruments would see of a state into sample `index` of a recording.
pub fn observed(system: &System<'_>, state: &[f64], index: usize, recording: &mut Recording) {
    let layout = system.layout();
    for (number, cylinder) in system.model().machine.cylinders.iter().enumerate() {
        let Some(signals) = recording.cylinders.iter_mut().find(|signals| signals.name == cylinder.name) else {
            continue;
        };
        let joint = state[layout.joint(number)];
        signals.joint_angle[index] = joint;
        signals.displacement[index] = cylinder.linkage.displacement(joint);
        signals.velocity[index] = cylinder.linkage.lever(joint) * state[layout.rate(number)];
        if let (Some(cap), Some(rod)) = (layout.cap_pressure(number), layout.rod_pressure(number)) {
            signals.cap_pressure[index] = state[cap];
            signals.rod_pressure[index] = state[rod];
        }
    }
    if let Some(pump) = layout.pump {
        recording.pump_pressure[index] = state[pump];
    }
}
