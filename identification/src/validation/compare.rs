//! Simulates a model with the input of a recording from its initial state, and compares every output.

use excavator_model::Model;
use excavator_model::machine::{Cylinder, Machine};
use excavator_model::recording::{Recording, is_measured, noise_level};
use excavator_model::simulation::{InputSignals, RunError, simulate};

use super::measures::mean_normalised;
use super::{
    Correlation, ErrorSums, MotionPhase, PhaseShare, autocorrelation, dominant_frequency, input_correlation,
    motion_phases, phase_delay_degrees, phase_shares,
};
use crate::regression::{observe, slope_noise};

/// A measurement and its simulation.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// The measured signals. Velocities that were not measured are derived from displacement.
    pub measured: Recording,
    /// The simulation with the same input.
    pub simulated: Recording,
    /// One entry per signal that both have.
    pub signals: Vec<SignalComparison>,
    /// Dominant frequency of the excitation, Hz, if there is one.
    pub excitation_frequency: Option<f64>,
    /// The machine, which determines the units of its signals.
    pub machine: Machine,
}

/// One signal.
#[derive(Debug, Clone, PartialEq)]
pub struct SignalComparison {
    /// Contract name.
    pub name: String,
    /// Measures of the error.
    pub error: ErrorSums,
    /// SI unit of the signal.
    pub unit: &'static str,
    /// Lag of the model behind the measurement at the excitation frequency, degrees.
    pub phase_delay_degrees: Option<f64>,
    /// Correlation of the error with its own past. It is not significant if only noise is left.
    pub autocorrelation: Option<Correlation>,
    /// Correlation of the error with the machine's input: the valve opening of its cylinder (for the pump pressure the
    /// sum of all), the velocity of an imposed motion, or the force on the load.
    pub input_correlation: Option<Correlation>,
    /// Distribution of the squared error over the motion phases of its cylinder's piston. For the pump line all pistons
    /// count: it is moving if one moves, and at an end only if no piston is elsewhere.
    pub phases: Vec<PhaseShare>,
}

impl Comparison {
    /// Mean normalised squared error over the signals that tell it ([`ErrorSums::tells`]).
    pub fn mean_error(&self) -> f64 {
        mean_error_of(std::slice::from_ref(self))
    }
}

/// Piston velocity of each cylinder, m/s: the measured one, or the slope of the displacement.
///
/// # Errors
/// [`RunError::Signal`] if inputs of the model are missing.
pub fn measured_velocity(model: &Model, recording: &Recording) -> Result<Vec<Vec<f64>>, RunError> {
    Ok(observe(model, recording)?.cylinders.into_iter().map(|cylinder| cylinder.velocity).collect())
}

/// Compares `model` with `recording`.
///
/// ```
/// use excavator_identification::prelude::*;
/// use excavator_model::prelude::*;
///
/// let machine = built_in("zx30u-arm")?;
/// # let time: Vec<f64> = (0..8000).map(|sample| f64::from(sample) * 2e-3).collect();
/// # let mut command = Recording::unmeasured("swing", time, &["arm"]);
/// # command.tank_pressure.fill(3e5);
/// # let area = |t: &f64| 5e-5 * (3.1 * t).sin() + 3e-5 * (7.3 * t).sin();
/// # command.cylinders[0].orifice_area = command.time.iter().map(area).collect();
/// let recording = simulate_from_rest(&machine, &command, &[0.1], Tolerances::default().scaled(0.05))?;
/// // A model whose numbers are a tenth too large.
/// let mut given = machine.clone();
/// given.parameters_mut().filter(|parameter| !parameter.known).for_each(|parameter| parameter.value *= 1.1);
///
/// let (right, wrong) = (compare(&machine, &recording)?, compare(&given, &recording)?);
/// assert!(right.mean_error() < wrong.mean_error());
/// for signal in &wrong.signals {
///     println!("{}: fit {:.1} %", signal.name, signal.error.fit_percent());
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] if the recording lacks inputs or the simulation fails.
pub fn compare(model: &Model, recording: &Recording) -> Result<Comparison, RunError> {
    beside(model, recording, simulate(model, recording)?)
}

/// Compares a recording with other signals at the same sample times.
///
/// # Errors
/// [`RunError`] if the recording lacks inputs.
pub(super) fn beside(model: &Model, recording: &Recording, simulated: Recording) -> Result<Comparison, RunError> {
    let mut measured = recording.clone();
    for (cylinder, velocity) in model.machine.cylinders.iter().zip(measured_velocity(model, recording)?) {
        if let Some(signals) = measured.cylinders.iter_mut().find(|signals| signals.name == cylinder.name) {
            signals.velocity = velocity;
        }
    }
    let inputs = InputSignals::from_recording(model, recording)?;
    // The constants for lags and frequencies are for a machine of the reference size.
    let unit = model.machine.size().time();
    let time: Vec<f64> = recording.time.iter().map(|time| time / unit).collect();
    let frequency = |signal: &[f64]| Some(dominant_frequency(&time, signal)? / unit);
    let in_seconds = |found: Correlation| Correlation { lag: found.lag * unit, ..found };
    let excitation_frequency = if model.machine.has_chambers() {
        frequency(inputs.orifice_area(0))
    } else if model.machine.has_imposed_motion() {
        None
    } else {
        frequency(&measured.cylinders[0].rod_force)
    };
    let own_phases: Vec<Vec<MotionPhase>> = model
        .machine
        .cylinders
        .iter()
        .map(|cylinder| {
            let own = measured.cylinder(&cylinder.name).ok();
            own.map_or_else(Vec::new, |own| motion_phases(&own.displacement, &own.velocity, cylinder))
        })
        .collect();
    let together: Vec<MotionPhase> = (0..measured.len())
        .filter_map(|sample| own_phases.iter().filter_map(|phases| phases.get(sample)).min().copied())
        .collect();
    // Each output with the number of the cylinder whose input drives it; the pump line has no input of its own.
    let mut names = Vec::new();
    for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
        if cylinder.imposed_motion.is_some() {
            names.push((format!("{}.rod_force", cylinder.name), Some(number)));
            continue;
        }
        for signal in ["displacement", "velocity", "cap_pressure", "rod_pressure"] {
            if cylinder.chambers.is_some() || !signal.ends_with("pressure") {
                names.push((format!("{}.{signal}", cylinder.name), Some(number)));
            }
        }
    }
    if matches!(model.machine.supply, excavator_model::machine::Supply::PumpLine(_)) {
        names.push(("pump_pressure".to_string(), None));
    }
    let signals = names
        .into_iter()
        .filter_map(|(name, cylinder)| {
            let (y, yhat) = (measured.signal(&name)?, simulated.signal(&name)?);
            if !is_measured(y) {
                return None;
            }
            let error: Vec<f64> = y.iter().zip(yhat).map(|(measured, simulated)| measured - simulated).collect();
            let input = driving_input(model, &inputs, &measured, cylinder);
            Some(SignalComparison {
                phase_delay_degrees: excitation_frequency
                    .and_then(|frequency| phase_delay_degrees(&recording.time, y, yhat, frequency)),
                autocorrelation: autocorrelation(&time, &error).map(in_seconds),
                input_correlation: input_correlation(&time, &error, &input).map(in_seconds),
                error: ErrorSums::of(y, yhat, noise_of(model, recording, &name, y)),
                unit: unit_of(&name, cylinder.map(|number| &model.machine.cylinders[number])),
                phases: phase_shares(cylinder.map_or(&together, |number| &own_phases[number]), &error),
                name,
            })
        })
        .collect();
    Ok(Comparison { measured, simulated, signals, excitation_frequency, machine: model.machine.clone() })
}

/// SI unit of an output with this contract name, of this cylinder or motor.
fn unit_of(name: &str, cylinder: Option<&Cylinder>) -> &'static str {
    let is_motor = cylinder.is_some_and(Cylinder::is_motor);
    match name.rsplit('.').next().unwrap_or(name) {
        "displacement" if is_motor => "rad",
        "displacement" => "m",
        "velocity" if is_motor => "rad/s",
        "velocity" => "m/s",
        "rod_force" if is_motor => "N m",
        "rod_force" => "N",
        _ => "Pa",
    }
}

/// Noise of a compared signal, in its unit. That of a velocity which was not measured comes from the displacement.
fn noise_of(model: &Model, recording: &Recording, name: &str, measured: &[f64]) -> f64 {
    if recording.signal(name).is_some_and(is_measured) {
        return noise_level(measured);
    }
    let place = name.strip_suffix(".velocity").unwrap_or_default();
    let cylinder = model.machine.cylinders.iter().position(|cylinder| cylinder.name == place);
    cylinder.map_or(f64::NAN, |cylinder| slope_noise(model, recording, cylinder))
}

/// Errors of each signal of one model over all samples of several recordings, in the order of the first.
pub fn errors_of(comparisons: &[Comparison]) -> Vec<(&str, ErrorSums)> {
    let mut names: Vec<&str> = Vec::new();
    for signal in comparisons.iter().flat_map(|comparison| &comparison.signals) {
        if !names.contains(&signal.name.as_str()) {
            names.push(&signal.name);
        }
    }
    let own = |name: &str| {
        let signals = comparisons.iter().flat_map(|comparison| &comparison.signals);
        ErrorSums::joined(signals.filter(|signal| signal.name == name).map(|signal| signal.error))
    };
    names.into_iter().map(|name| (name, own(name))).collect()
}

/// Mean over the signals of the normalised squared error over all samples of several recordings: the one number by which models are
/// compared.
pub fn mean_error_of(comparisons: &[Comparison]) -> f64 {
    let errors: Vec<ErrorSums> = errors_of(comparisons).into_iter().map(|(_, error)| error).collect();
    mean_normalised(&errors)
}

/// [`mean_error_of`] `model` on these recordings.
///
/// # Errors
/// [`RunError`] as of [`compare`].
pub fn mean_error(model: &Model, recordings: &[&Recording]) -> Result<f64, RunError> {
    let comparisons = recordings.iter().map(|recording| compare(model, recording));
    Ok(mean_error_of(&comparisons.collect::<Result<Vec<_>, RunError>>()?))
}

/// The input of a cylinder, or the sum over all.
fn driving_input(model: &Model, inputs: &InputSignals, measured: &Recording, cylinder: Option<usize>) -> Vec<f64> {
    match cylinder {
        Some(number) if model.machine.cylinders[number].chambers.is_some() => inputs.orifice_area(number).to_vec(),
        Some(number) => {
            let Ok(signals) = measured.cylinder(&model.machine.cylinders[number].name) else { return Vec::new() };
            if model.machine.has_imposed_motion() { signals.velocity.clone() } else { signals.rod_force.clone() }
        }
        None => {
            let cylinders = model.machine.cylinders.len();
            let total = |sample: usize| (0..cylinders).map(|number| inputs.orifice_area(number)[sample].abs()).sum();
            (0..inputs.len()).map(total).collect()
        }
    }
}
