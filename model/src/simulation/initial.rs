//! Determines the initial state of a simulation from measurements.

use crate::equations::{Channel, Distortion, Inputs, Layout, System};
use crate::recording::Recording;
use crate::{Model, SignalError};

/// Averaging time for the initial state, s: long enough to average the noise of a 500 Hz recording over ten samples, short
/// compared with the dynamics of an arm.
const WINDOW: f64 = 0.02;

/// The first sample from `from` on at which the measurements determine the position of every piston.
pub fn first_known_position(model: &Model, recording: &Recording, from: usize) -> Option<usize> {
    let signals: Vec<_> =
        model.machine.cylinders.iter().filter_map(|cylinder| recording.cylinder(&cylinder.name).ok()).collect();
    (from..recording.len()).find(|&sample| {
        signals.iter().all(|own| own.displacement[sample].is_finite() || own.joint_angle[sample].is_finite())
    })
}

/// State of `model` at sample `index` of a recording. Positions and pressures come from straight lines through the samples within
/// 0.02 s after it (on a machine of the reference size). The velocity is the slope of the displacement's line (\[A\] Section 4.1:
/// "estimated by just first order differentiation") unless it is measured. Unmeasured pressures start where forces balance.
/// `spool` has the valve openings at the sample, m². The distortions of the model's sensor effects are removed from the
/// measurements.
///
/// # Errors
/// [`SignalError::NoInitialState`] if displacement and joint angle of a cylinder are both missing there or impossible.
pub fn initial_state(
    system: &System<'_>,
    recording: &Recording,
    index: usize,
    spool: &[f64],
    tank_pressure: f64,
) -> Result<Vec<f64>, SignalError> {
    let model: &Model = system.model();
    let layout: &Layout = system.layout();
    let window = WINDOW * model.machine.size().time();
    let line = |channel: Channel, signal: &[f64]| {
        let Distortion { offset, delay } = system.own_instruments().of(channel);
        start_line(&recording.time, signal, index, delay, window).map(|(value, slope)| (value - offset, slope))
    };
    let mut state = vec![0.0; layout.len];
    let mut unmeasured = Vec::new();
    for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
        let signals = recording.cylinder(&cylinder.name)?;
        let missing = |reason: &str| SignalError::NoInitialState {
            source_name: recording.source.clone(),
            signal: format!("{}.displacement", cylinder.name),
            reason: reason.to_string(),
        };
        let displacement_line = line(Channel::Displacement(number), &signals.displacement);
        let angle_line = line(Channel::JointAngle(number), &signals.joint_angle);
        let (joint, rate) = match (displacement_line, angle_line) {
            (Some((displacement, slope)), _) => {
                let joint = cylinder.linkage.joint(displacement);
                let measured = line(Channel::Velocity(number), &signals.velocity).map(|(velocity, _)| velocity);
                (joint, measured.unwrap_or(slope) / cylinder.linkage.lever(joint))
            }
            (None, Some((joint, slope))) => (joint, slope),
            (None, None) => {
                return Err(missing("neither displacement nor joint angle is measured within 0.02 s of the start"));
            }
        };
        if !joint.is_finite() || !rate.is_finite() {
            return Err(missing("the measured value is outside what the linkage allows; check unit and offset"));
        }
        state[layout.joint(number)] = joint;
        state[layout.rate(number)] = rate;
        if let (Some(cap), Some(rod)) = (layout.cap_pressure(number), layout.rod_pressure(number)) {
            let at_start = |channel, signal: &[f64]| line(channel, signal).map(|(value, _)| value);
            let cap_measured = at_start(Channel::CapPressure(number), &signals.cap_pressure);
            let rod_measured = at_start(Channel::RodPressure(number), &signals.rod_pressure);
            state[cap] = cap_measured.unwrap_or(tank_pressure);
            state[rod] = rod_measured.unwrap_or(tank_pressure);
            unmeasured.push([cap_measured.is_none(), rod_measured.is_none()]);
        } else {
            unmeasured.push([false; 2]);
        }
    }
    for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
        if let Some(force) = layout.rod_force(number) {
            let measured = line(Channel::RodForce(number), &recording.cylinder(&cylinder.name)?.rod_force);
            state[force] = measured.map_or(0.0, |(value, _)| value);
        }
    }
    if let Some(pump) = layout.pump {
        let measured = line(Channel::PumpPressure, &recording.pump_pressure).map(|(value, _)| value);
        state[pump] = measured.unwrap_or(tank_pressure);
    }
    system.set_effect_states(spool, &mut state);
    if unmeasured.iter().any(|sides| sides[0] || sides[1]) {
        balance(system, spool, tank_pressure, &unmeasured, &mut state);
    }
    Ok(state)
}

/// Sets unmeasured pressures so that the forces on the piston balance, as far as pressures above tank allow. If both sides of a
/// cylinder are unmeasured, the side that carries the load is above tank pressure.
fn balance(system: &System<'_>, spool: &[f64], tank_pressure: f64, unmeasured: &[[bool; 2]], state: &mut [f64]) {
    let (model, layout) = (system.model(), system.layout());
    let mut inputs = Inputs::<f64>::zero(layout.joints);
    inputs.tank_pressure = tank_pressure;
    for (slot, &area) in inputs.orifice_area.iter_mut().zip(spool) {
        *slot = area;
    }
    let mut workspace = system.workspace::<f64>();
    let mut rates = vec![0.0; layout.len];
    system.rates(&mut workspace, &model.parameter_values(), state, &inputs, &mut rates);
    for (number, &[no_cap, no_rod]) in unmeasured.iter().enumerate() {
        let Some(chambers) = model.machine.cylinders[number].chambers else { continue };
        let (Some(cap), Some(rod)) = (layout.cap_pressure(number), layout.rod_pressure(number)) else { continue };
        let piston = &workspace.situation.pistons[number];
        let load = workspace.rows.torque[number] / piston.lever + workspace.rows.piston_force[number];
        let cap_needed = (state[rod] * chambers.rod_area - load) / chambers.cap_area;
        let rod_needed = (state[cap] * chambers.cap_area + load) / chambers.rod_area;
        if no_cap && cap_needed.is_finite() && cap_needed > tank_pressure {
            state[cap] = cap_needed;
        } else if no_rod && rod_needed.is_finite() && rod_needed > tank_pressure {
            state[rod] = rod_needed;
        }
    }
}

/// Value and slope of a signal with a delay of `delay` s, at sample `index`: from the straight line through the values reported
/// within `window` s after the delay.
fn start_line(time: &[f64], signal: &[f64], index: usize, delay: f64, window: f64) -> Option<(f64, f64)> {
    let start = *time.get(index)? + delay;
    // Rounding of the clock must not exclude the first point.
    let first = time.partition_point(|&t| t < start - 1e-9);
    let points: Vec<(f64, f64)> = time[first..]
        .iter()
        .zip(&signal[first..])
        .take_while(|(t, _)| **t - start <= window)
        .filter(|(_, value)| value.is_finite())
        .map(|(t, value)| (t - start, *value))
        .collect();
    let count = points.len() as f64;
    if points.is_empty() {
        return None;
    }
    let mean_time = points.iter().map(|point| point.0).sum::<f64>() / count;
    let mean = points.iter().map(|point| point.1).sum::<f64>() / count;
    let spread: f64 = points.iter().map(|point| (point.0 - mean_time).powi(2)).sum();
    if spread == 0.0 {
        return Some((mean, 0.0));
    }
    let slope = points.iter().map(|point| (point.0 - mean_time) * (point.1 - mean)).sum::<f64>() / spread;
    Some((mean - slope * mean_time, slope))
}
