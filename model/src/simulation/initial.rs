//! The state at which a simulation starts, from what was measured there.

use crate::equations::{Layout, System};
use crate::recording::Recording;
use crate::{Model, SignalError};

/// Time over which measurements are averaged for a start, s: long enough to average noise of a 500 Hz recording over
/// ten samples, short against the dynamics of an arm.
const WINDOW: f64 = 0.02;

/// State of `model` at sample `index` of a recording. Positions and pressures come from straight lines through the
/// samples within 0.02 s after it, velocity is the slope of the displacement's line (\[A\] Section 4.1: "estimated by just
/// first order differentiation") unless it is measured. Pressures that nobody measures start at tank pressure. `spool`
/// gives the valve openings at the sample, m².
///
/// # Errors
/// [`SignalError::NoInitialState`] when displacement and joint angle of a cylinder are both missing there or impossible.
pub fn initial_state(
    system: &System<'_>,
    recording: &Recording,
    index: usize,
    spool: &[f64],
    tank_pressure: f64,
) -> Result<Vec<f64>, SignalError> {
    let model: &Model = system.model();
    let layout: &Layout = system.layout();
    let mut state = vec![0.0; layout.len];
    for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
        let signals = recording.cylinder(&cylinder.name)?;
        let missing = |reason: &str| SignalError::NoInitialState {
            source_name: recording.source.clone(),
            signal: format!("{}.displacement", cylinder.name),
            reason: reason.to_string(),
        };
        let line = start_line(&recording.time, &signals.displacement, index);
        let angle_line = start_line(&recording.time, &signals.joint_angle, index);
        let (joint, rate) = match (line, angle_line) {
            (Some((displacement, slope)), _) => {
                let joint = cylinder.linkage.joint(displacement);
                let measured = start_line(&recording.time, &signals.velocity, index).map(|(velocity, _)| velocity);
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
            let at_start = |signal: &[f64]| start_line(&recording.time, signal, index).map(|(value, _)| value);
            state[cap] = at_start(&signals.cap_pressure).unwrap_or(tank_pressure);
            state[rod] = at_start(&signals.rod_pressure).unwrap_or(tank_pressure);
        }
    }
    if let Some(pump) = layout.pump {
        let measured = start_line(&recording.time, &recording.pump_pressure, index).map(|(value, _)| value);
        state[pump] = measured.unwrap_or(tank_pressure);
    }
    for (effect, &(first, states)) in model.effects.iter().zip(&layout.effect_states) {
        if let crate::effects::Site::Cylinder(number) = effect.site {
            state[first..first + states].fill(spool.get(number).copied().unwrap_or(0.0));
        }
    }
    Ok(state)
}

/// Value and slope at sample `index` of the straight line through the values within [`WINDOW`] after it.
fn start_line(time: &[f64], signal: &[f64], index: usize) -> Option<(f64, f64)> {
    let start = *time.get(index)?;
    let points: Vec<(f64, f64)> = time[index..]
        .iter()
        .zip(&signal[index..])
        .take_while(|(t, _)| **t - start <= WINDOW)
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
