//! Computes the state along a recording, sample by sample.

use excavator_model::Model;
use excavator_model::effects::Number;
use excavator_model::equations::{KnownCylinder, System};
use excavator_model::recording::{CylinderSignals, Recording, denoised, noise_level};
use excavator_model::simulation::InputSignals;

/// The known part of the state at each sample: raw signals for differentiation, smooth ones for formulas.
#[derive(Debug, Clone)]
pub struct Observation {
    /// Sample times, s.
    pub time: Vec<f64>,
    /// Inputs at the same times.
    pub inputs: InputSignals,
    /// One entry per cylinder.
    pub cylinders: Vec<CylinderObservation>,
    /// Pump pressure as measured, Pa.
    pub pump_pressure: Vec<f64>,
    /// Pump pressure without noise, Pa.
    pub smooth_pump_pressure: Vec<f64>,
}

/// The known state of one cylinder at each sample.
#[derive(Debug, Clone)]
pub struct CylinderObservation {
    /// Joint coordinate from the displacement (or joint angle) as measured, rad or m.
    pub joint: Vec<f64>,
    /// Displacement as measured, m.
    pub displacement: Vec<f64>,
    /// Pressures as measured, Pa: cap side, rod side.
    pub pressures: [Vec<f64>; 2],
    /// Displacement without noise, m.
    pub smooth_displacement: Vec<f64>,
    /// Piston velocity, m/s; the slope of the displacement if it is not measured.
    pub velocity: Vec<f64>,
    /// Pressures without noise, Pa.
    pub smooth_pressures: [Vec<f64>; 2],
}

/// Half width of the parabola whose slope is the velocity, s. It averages 21 samples at 500 Hz and is shorter than the
/// fastest swing of an arm (0.1 s).
const SLOPE_HALF_WIDTH: f64 = 0.02;

/// The same in sample intervals, for slow recordings: five samples for three coefficients.
const SLOPE_HALF_WIDTH_SAMPLES: f64 = 2.5;

/// The state along `recording`, as far as it is measured.
///
/// # Errors
/// [`excavator_model::SignalError`] if the model's inputs are missing.
pub fn observe(model: &Model, recording: &Recording) -> Result<Observation, excavator_model::SignalError> {
    observe_against(model, recording, None)
}

/// Like [`observe`], but removes noise from the difference between pressures and their simulation, not from the
/// pressures themselves. Smoothing a signal flattens its peaks. The difference has few, and is only noise if the
/// simulation is right. Velocities remain slopes of the measured signals: on a real drive (EMPS) the simulated velocity
/// of a model with too simple friction shifted the identified friction by 2 %.
///
/// # Errors
/// [`excavator_model::SignalError`] if the model's inputs are missing.
pub fn observe_guided(
    model: &Model,
    recording: &Recording,
    simulation: &Recording,
) -> Result<Observation, excavator_model::SignalError> {
    observe_against(model, recording, Some(simulation))
}

fn observe_against(
    model: &Model,
    recording: &Recording,
    guide: Option<&Recording>,
) -> Result<Observation, excavator_model::SignalError> {
    let inputs = InputSignals::from_recording(model, recording)?;
    let mut cylinders = Vec::new();
    for cylinder in &model.machine.cylinders {
        let signals = recording.cylinder(&cylinder.name)?;
        let guiding = guide.map(|simulation| simulation.cylinder(&cylinder.name)).transpose()?;
        let displacement = displacement(signals, |joint| cylinder.linkage.displacement(joint));
        let joint: Vec<f64> = displacement.iter().map(|&s| cylinder.linkage.joint(s)).collect();
        let measured_velocity = signals.velocity.iter().any(|v| v.is_finite());
        let half_width = slope_half_width(model, recording);
        let (mut smooth_displacement, mut slope) = (Vec::new(), Vec::new());
        // Samples across a pause are not neighbours.
        for piece in recording.pieces() {
            let (values, slopes) = parabolas(&recording.time[piece.clone()], &displacement[piece], half_width);
            smooth_displacement.extend(values);
            slope.extend(slopes);
        }
        cylinders.push(CylinderObservation {
            joint,
            smooth_displacement,
            velocity: if measured_velocity { smooth(&signals.velocity, None) } else { slope },
            smooth_pressures: [
                smooth(&signals.cap_pressure, guiding.map(|simulated| &simulated.cap_pressure)),
                smooth(&signals.rod_pressure, guiding.map(|simulated| &simulated.rod_pressure)),
            ],
            pressures: [signals.cap_pressure.clone(), signals.rod_pressure.clone()],
            displacement,
        });
    }
    Ok(Observation {
        time: recording.time.clone(),
        inputs,
        cylinders,
        smooth_pump_pressure: smooth(&recording.pump_pressure, guide.map(|simulation| &simulation.pump_pressure)),
        pump_pressure: recording.pump_pressure.clone(),
    })
}

/// Half width of the parabola whose slope is the velocity, s.
fn slope_half_width(model: &Model, recording: &Recording) -> f64 {
    (SLOPE_HALF_WIDTH * model.machine.size().time()).max(SLOPE_HALF_WIDTH_SAMPLES * recording.sample_interval())
}

/// Noise of a velocity that is the slope of the displacement of this cylinder, m/s: a slope over samples at `t` about their middle
/// has the noise of one sample over `sqrt(sum t²)`. `NaN` if no displacement is measured.
pub(crate) fn slope_noise(model: &Model, recording: &Recording, cylinder: usize) -> f64 {
    let constants = &model.machine.cylinders[cylinder];
    let Ok(signals) = recording.cylinder(&constants.name) else { return f64::NAN };
    let interval = recording.sample_interval();
    let each_side = (slope_half_width(model, recording) / interval).floor();
    let squares = each_side * (each_side + 1.0) * (2.0 * each_side + 1.0) / 3.0;
    let positions = displacement(signals, |joint| constants.linkage.displacement(joint));
    noise_level(&positions) / (interval * squares.sqrt())
}

impl Observation {
    /// Writes the state at a sample to `state`, with these states of effects.
    pub(super) fn set_state<T: Number>(
        &self,
        system: &System<'_>,
        sample: usize,
        effect_states: Option<&Vec<f64>>,
        state: &mut [T],
    ) {
        let known = |number: usize| {
            let own = &self.cylinders[number];
            let joint = system.model().machine.cylinders[number].linkage.joint(own.smooth_displacement[sample]);
            let pressures = [0, 1].map(|side: usize| own.smooth_pressures[side][sample]);
            KnownCylinder { joint, velocity: own.velocity[sample], pressures }
        };
        system.set_measured(known, self.smooth_pump_pressure[sample], state);
        if let Some(states) = effect_states {
            let start = state.len() - states.len();
            for (slot, &value) in state[start..].iter_mut().zip(states) {
                *slot = T::from(value);
            }
        }
    }

    /// The same with pressures as they were measured: whatever averages them later needs their corners.
    #[must_use]
    pub(super) fn with_measured_pressures(mut self) -> Self {
        for cylinder in &mut self.cylinders {
            cylinder.smooth_pressures.clone_from(&cylinder.pressures);
        }
        self.smooth_pump_pressure.clone_from(&self.pump_pressure);
        self
    }
}

fn displacement(signals: &CylinderSignals, from_joint: impl Fn(f64) -> f64) -> Vec<f64> {
    let pairs = signals.displacement.iter().zip(&signals.joint_angle);
    pairs.map(|(&s, &q)| if s.is_finite() { s } else { from_joint(q) }).collect()
}

/// Removes noise from a signal without holes. A signal with holes is returned unchanged, because windows with holes are
/// left out anyway.
fn smooth(signal: &[f64], guide: Option<&Vec<f64>>) -> Vec<f64> {
    // A corrected delay leaves a hole at the end. The rest is still smoothed.
    let last = signal.iter().rposition(|value| value.is_finite()).map_or(0, |index| index + 1);
    let (measured, rest) = signal.split_at(last);
    if measured.iter().any(|value| !value.is_finite()) {
        return signal.to_vec();
    }
    let mut smooth = match guide {
        None => denoised(measured),
        Some(guide) => {
            let difference: Vec<f64> = measured.iter().zip(guide).map(|(measured, guide)| measured - guide).collect();
            denoised(&difference).iter().zip(guide).map(|(difference, guide)| difference + guide).collect()
        }
    };
    smooth.extend_from_slice(rest);
    smooth
}

/// Value and slope, at each sample, of the least-squares parabola through the samples within `half_width`, s.
fn parabolas(time: &[f64], signal: &[f64], half_width: f64) -> (Vec<f64>, Vec<f64>) {
    let mut values = Vec::with_capacity(signal.len());
    let mut slopes = Vec::with_capacity(signal.len());
    let (mut first, mut last) = (0, 0);
    let (start, end) = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(0.0));
    for &centre in time {
        while time[first] < centre - half_width {
            first += 1;
        }
        while last < time.len() && time[last] <= centre + half_width {
            last += 1;
        }
        let (value, slope) =
            parabola(&time[first..last], &signal[first..last], centre, half_width).unwrap_or((f64::NAN, f64::NAN));
        values.push(value);
        // One-sided slopes at the ends are several times noisier, so there are no slopes there.
        let whole = centre - half_width >= start && centre + half_width <= end;
        slopes.push(if whole { slope } else { f64::NAN });
    }
    (values, slopes)
}

fn parabola(time: &[f64], signal: &[f64], centre: f64, half_width: f64) -> Option<(f64, f64)> {
    let mut matrix = nalgebra::Matrix3::zeros();
    let mut right = nalgebra::Vector3::zeros();
    let origin = *signal.first()?;
    for (&t, &value) in time.iter().zip(signal) {
        // In units of the half width, so that the normal equations are well conditioned.
        let x = (t - centre) / half_width;
        let powers = nalgebra::Vector3::new(1.0, x, x * x);
        matrix += powers * powers.transpose();
        right += powers * (value - origin);
    }
    let solution = matrix.cholesky()?.solve(&right);
    Some((solution[0] + origin, solution[1] / half_width))
}
