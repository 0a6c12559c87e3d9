//! Simulates whole recordings.

use super::{
    InputSignals, Integrator, Observer, SimulationError, Tolerances, first_known_position, initial_state, rest_state,
};
use crate::Model;
use crate::SignalError;
use crate::equations::{Channel, System};
use crate::machine::Supply;
use crate::recording::Recording;

/// Why a simulation failed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The recording lacks an input of the model.
    #[error(transparent)]
    Signal(#[from] SignalError),
    /// The integration stopped early.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

/// Simulates `model` with the inputs of `recording` from the state measured at its start. The result has the recording's
/// clock and inputs, and displacement, velocity, joint angle and pressures as its instruments report them.
///
/// Each piece of the recording ([`Recording::pieces_after`]) is simulated from its own start, because the time between pieces is
/// unknown. Simulated signals are `NaN` before the first measured position of a piece.
///
/// ```
/// use excavator_model::prelude::*;
///
/// let model = built_in("zx30u-arm")?;
/// let time: Vec<f64> = (0..=2000).map(|sample| f64::from(sample) * 1e-3).collect();
/// let mut command = Recording::unmeasured("sine", time, &["arm"]);
/// command.cylinders[0].orifice_area = command.time.iter().map(|t| 6e-5 * (3.0 * t).sin()).collect();
/// // What another program would read from a bag.
/// let measured = simulate_from_rest(&model, &command, &[0.0], Tolerances::default())?;
///
/// let simulated = simulate(&model, &measured)?;
/// let [ours, theirs] = [&simulated, &measured].map(|recording| recording.cylinders[0].displacement[2000]);
/// assert!((ours - theirs).abs() < 1e-3, "{ours} m and {theirs} m");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`].
pub fn simulate(model: &Model, recording: &Recording) -> Result<Recording, RunError> {
    let pieces = recording.pieces_after(MEMORY * model.machine.size().time().min(1.0));
    if pieces.len() < 2 && matches!(first_known_position(model, recording, 0), Some(0) | None) {
        return simulate_piece(model, recording);
    }
    let mut simulated = recording.clone();
    simulated.source = format!("{} simulated", model.machine.name);
    fill_simulated(model, &mut simulated, f64::NAN);
    let mut known = 0;
    let mut failure = None;
    for piece in pieces {
        let first = first_known_position(model, recording, piece.start).unwrap_or(piece.start);
        let piece = if piece.contains(&first) { first..piece.end } else { piece };
        let mut part = recording.at(&piece.clone().collect::<Vec<usize>>());
        match simulate_piece(model, &part) {
            Ok(simulated) => {
                part = simulated;
                known += 1;
            }
            Err(RunError::Signal(error)) => {
                fill_simulated(model, &mut part, f64::NAN);
                failure.get_or_insert(error);
            }
            Err(error) => return Err(error),
        }
        for (whole, part) in simulated.columns_mut().into_iter().zip(part.columns_mut()) {
            whole[piece.clone()].copy_from_slice(part);
        }
    }
    match failure {
        Some(error) if known == 0 => Err(error.into()),
        _ => Ok(simulated),
    }
}

/// Sets all simulated signals to `value` at all samples.
fn fill_simulated(model: &Model, recording: &mut Recording, value: f64) {
    let system = System::new(model);
    for channel in Channel::all(system.layout()) {
        if let Some(values) = channel.signal_mut(&model.machine, recording) {
            values.fill(value);
        }
    }
}

/// Time after which the state before a pause says nothing about the state after it, s on a machine of the reference size: an arm comes to
/// rest by itself within this time.
const MEMORY: f64 = 2.0;

fn simulate_piece(model: &Model, recording: &Recording) -> Result<Recording, RunError> {
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
    let parameters = model.parameter_values();
    let mut integrator = Integrator::new(&system, &parameters, &[], tolerances);
    let mut observer = Observer::new(&system, &parameters, &[], &Channel::all(system.layout()));
    let mut simulated = recording.clone();
    simulated.source = format!("{} simulated", model.machine.name);
    if let Supply::PressureSource(_) = model.machine.supply {
        simulated.pump_pressure.copy_from_slice(signals.supply_pressure());
    }
    integrator.follow(signals, &mut state, |index, state| observer.record(signals, index, state, &mut simulated))?;
    Ok(simulated)
}

/// Simulates `model` with the inputs of `recording` from rest at these piston displacements, m from mid-stroke, and with the
/// pressures that balance the forces there; see [`rest_state`].
///
/// ```
/// use excavator_model::prelude::*;
///
/// let model = built_in("zx30u-arm")?;
/// let time: Vec<f64> = (0..=1000).map(|sample| f64::from(sample) * 1e-3).collect();
/// let mut input = Recording::unmeasured("open", time, &["arm"]);
/// input.cylinders[0].orifice_area.fill(1e-4); // m²
/// let moved = simulate_from_rest(&model, &input, &[0.0], Tolerances::default())?;
/// assert!(moved.cylinders[0].displacement[1000] > 0.01); // m
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`].
pub fn simulate_from_rest(
    model: &Model,
    recording: &Recording,
    displacements: &[f64],
    tolerances: Tolerances,
) -> Result<Recording, RunError> {
    let signals = InputSignals::from_recording(model, recording)?;
    if signals.is_empty() {
        return Ok(recording.clone());
    }
    let state = rest_state(&System::new(model), displacements, &signals.at_start());
    Ok(simulate_from(model, recording, &signals, state, tolerances)?)
}

/// Writes the instrument readings of a state to sample `index` of a recording, as far as the state alone determines them:
/// with the model's sensor offsets, but without delays, which need the history; an [`Observer`] has both.
pub fn observed(system: &System<'_>, state: &[f64], index: usize, recording: &mut Recording) {
    let machine = &system.model().machine;
    for channel in Channel::all(system.layout()) {
        if let Some(values) = channel.signal_mut(machine, recording) {
            values[index] = channel.value(system, state) + system.own_instruments().of(channel).offset;
        }
    }
}
