//! Determines the initial state of a simulation from measurements.

use crate::equations::{Channel, Distortion, Inputs, Layout, System};
use crate::recording::Recording;
use crate::{Model, SignalError};

/// Averaging time for the initial state, s: long enough to average the noise of a 500 Hz recording over ten samples, short
/// compared with the dynamics of an arm.
const WINDOW: f64 = 0.02;

/// Fewest samples of a position from which its speed is taken. At 100 Hz the slope of three samples is noise: 0.4 mm of it start a heavy
/// load with 25 mm/s, and its pressures ring by 1 MPa.
const FEWEST: usize = 10;

/// The first sample from `from` on at which the measurements determine the position of every piston.
pub fn first_known_position(model: &Model, recording: &Recording, from: usize) -> Option<usize> {
    let signals: Vec<_> =
        model.machine.cylinders.iter().filter_map(|cylinder| recording.cylinder(&cylinder.name).ok()).collect();
    (from..recording.len()).find(|&sample| {
        signals.iter().all(|own| own.displacement[sample].is_finite() || own.joint_angle[sample].is_finite())
    })
}

/// State of `model` at sample `index` of a recording. Positions and pressures come from straight lines through the samples within
/// 0.02 s after it (on a machine of the reference size), positions through ten samples at least. The velocity is the slope of the displacement's line (\[A\] Section 4.1:
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
        // A position bends with the acceleration. Pressures and speeds can have corners, which a parabola overshoots.
        let bends = matches!(channel, Channel::Displacement(_) | Channel::JointAngle(_));
        start_line(&recording.time, signal, index, delay, window, bends).map(|(value, slope)| (value - offset, slope))
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

/// Squared size of the bend of a signal, in standard errors, above which its start is taken from a parabola. With noise alone, one start
/// in 500 has a bend of this size in ten samples.
const BENT: f64 = 20.0;

/// Value and slope of a signal with a delay of `delay` s, at sample `index`: from the straight line through the values reported within
/// `window` s after the delay. If the signal `bends`, through ten samples at least, and from the parabola through them where they bend.
/// A line has the slope of the middle of the window: of a drive that starts with 1 m/s² it is 10 mm/s off.
fn start_line(time: &[f64], signal: &[f64], index: usize, delay: f64, window: f64, bends: bool) -> Option<(f64, f64)> {
    let start = *time.get(index)? + delay;
    let fewest = if bends { FEWEST } else { 1 };
    // Rounding of the clock must not exclude the first point.
    let first = time.partition_point(|&t| t < start - 1e-9);
    let points: Vec<(f64, f64)> = time[first..]
        .iter()
        .zip(&signal[first..])
        .enumerate()
        .take_while(|(number, (t, _))| **t - start <= window || *number < fewest)
        .filter(|(_, (_, value))| value.is_finite())
        .map(|(_, (t, value))| (t - start, *value))
        .collect();
    let count = points.len() as f64;
    if points.is_empty() {
        return None;
    }
    let mean_time = points.iter().map(|point| point.0).sum::<f64>() / count;
    let mean = points.iter().map(|point| point.1).sum::<f64>() / count;
    // The line is fitted about the middle, and the bend with what is orthogonal to it.
    let centred = || points.iter().map(|point| (point.0 - mean_time, point.1 - mean));
    let sum = |of: &dyn Fn(f64, f64) -> f64| centred().map(|(t, value)| of(t, value)).sum::<f64>();
    let spread = sum(&|t, _| t * t);
    if spread == 0.0 {
        return Some((mean, 0.0));
    }
    let slope = sum(&|t, value| t * value) / spread;
    let (skew, square) = (sum(&|t, _| t * t * t) / spread, spread / count);
    let curve = |t: f64| t * t - skew * t - square;
    let curved = sum(&|t, _| curve(t).powi(2));
    let bend = if curved > 0.0 { sum(&|t, value| curve(t) * value) / curved } else { 0.0 };
    let explained = bend * bend * curved;
    let left = (sum(&|t, value| (value - slope * t).powi(2)) - explained).max(0.0);
    let freedom = count - 3.0;
    if bends && freedom >= 1.0 && explained * freedom > BENT * left && explained > ROUNDING * mean * mean * count {
        let value = mean - slope * mean_time + bend * curve(-mean_time);
        return Some((value, slope + bend * (-2.0 * mean_time - skew)));
    }
    Some((mean - slope * mean_time, slope))
}

/// Squared bends below this share of the squared signal are rounding.
const ROUNDING: f64 = 1e-24;

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn start(signal: impl Fn(f64, usize) -> f64) -> (f64, f64) {
        let time: Vec<f64> = (0..30).map(|k| 1e-3 * f64::from(k)).collect();
        let values: Vec<f64> = time.iter().enumerate().map(|(k, t)| signal(*t, k)).collect();
        start_line(&time, &values, 0, 0.0, 0.02, true).unwrap()
    }

    #[test]
    fn a_start_with_acceleration_has_the_speed_of_its_first_moment() {
        let (value, slope) = start(|t, _| 0.1 + 0.006 * t + 0.5 * t * t);
        assert!((value - 0.1).abs() < 1e-12 && (slope - 0.006).abs() < 1e-9, "{value} {slope}");
    }

    /// A load at rest, read ten times in a tenth of a second with 0.4 mm of noise.
    #[test]
    fn a_slow_recording_of_a_load_at_rest_starts_at_rest() {
        let time: Vec<f64> = (0..30).map(|k| 1e-2 * f64::from(k)).collect();
        let noise = [3.0, -5.0, 1.0, 7.0, -2.0, -6.0, 4.0, 0.0, -7.0, 5.0];
        let values: Vec<f64> = (0..30).map(|k| 0.2 + 1e-4 * noise[k % 10]).collect();
        let (_, few) = start_line(&time, &values, 0, 0.0, 0.02, false).unwrap();
        let (_, many) = start_line(&time, &values, 0, 0.0, 0.02, true).unwrap();
        assert!(few.abs() > 8e-3 && many.abs() < 2e-3, "{few} {many}");
    }

    #[test]
    fn noise_does_not_bend_a_start() {
        let noise =
            [3, -5, 1, 7, -2, -6, 4, 0, -7, 5, 2, -4, 6, -1, -3, 7, -6, 3, -2, 1, 5, -5, 0, 2, -7, 4, 6, -1, -4, 3];
        let (value, slope) = start(|t, k| 0.1 + 0.2 * t + 1e-5 * f64::from(noise[k]));
        // The line has 2 noise / sqrt(21) at its end and noise / 0.028 s in its slope; a parabola has three times as much.
        assert!((value - 0.1).abs() < 5e-5 && (slope - 0.2).abs() < 4e-3, "{value} {slope}");
        let (value, slope) = start(|_, _| 0.3);
        assert!((value - 0.3).abs() < 1e-12 && slope.abs() < 1e-12, "{value} {slope}");
    }
}
