//! Simulate with a recording's input from its initial state, and compare every output.

use excavator_model::Model;
use excavator_model::recording::{Recording, is_measured};
use excavator_model::simulation::{InputSignals, RunError, simulate};

use super::{dominant_frequency, fit_percent, normalised_mean_squared_error, phase_delay_degrees};
use crate::regression::observe;

/// A measurement and its simulation.
#[derive(Debug, Clone)]
pub struct Comparison {
    /// What was measured; velocities that were not measured are derived from displacement.
    pub measured: Recording,
    /// What the model does with the same input.
    pub simulated: Recording,
    /// One entry per signal that both have.
    pub signals: Vec<SignalComparison>,
    /// Frequency of the excitation, Hz, where one stands out.
    pub excitation_frequency: Option<f64>,
}

/// One signal.
#[derive(Debug, Clone, PartialEq)]
pub struct SignalComparison {
    /// Contract name.
    pub name: String,
    /// Normalised mean squared error.
    pub normalised_error: f64,
    /// FIT in %.
    pub fit: f64,
    /// Lag of the model behind the measurement at the excitation frequency, degrees.
    pub phase_delay_degrees: Option<f64>,
}

impl Comparison {
    /// Mean normalised squared error over the signals.
    pub fn mean_error(&self) -> f64 {
        self.signals.iter().map(|signal| signal.normalised_error).sum::<f64>() / self.signals.len() as f64
    }
}

/// Piston velocity of a cylinder, m/s: as measured, else the slope of the displacement.
///
/// # Errors
/// [`RunError::Signal`] when inputs of the model are missing.
pub fn measured_velocity(model: &Model, recording: &Recording) -> Result<Vec<Vec<f64>>, RunError> {
    Ok(observe(model, recording)?.cylinders.into_iter().map(|cylinder| cylinder.velocity).collect())
}

/// Compares `model` with `recording`.
///
/// # Errors
/// [`RunError`] when the recording lacks inputs or the simulation fails.
pub fn compare(model: &Model, recording: &Recording) -> Result<Comparison, RunError> {
    let simulated = simulate(model, recording)?;
    let mut measured = recording.clone();
    for (cylinder, velocity) in model.machine.cylinders.iter().zip(measured_velocity(model, recording)?) {
        if let Some(signals) = measured.cylinders.iter_mut().find(|signals| signals.name == cylinder.name) {
            signals.velocity = velocity;
        }
    }
    let inputs = InputSignals::from_recording(model, recording)?;
    let excitation_frequency = if model.machine.has_chambers() {
        dominant_frequency(&recording.time, inputs.orifice_area(0))
    } else if model.machine.has_imposed_motion() {
        None
    } else {
        dominant_frequency(&recording.time, &measured.cylinders[0].rod_force)
    };
    let mut names = Vec::new();
    for cylinder in &model.machine.cylinders {
        if cylinder.imposed_motion.is_some() {
            names.push(format!("{}.rod_force", cylinder.name));
            continue;
        }
        for signal in ["displacement", "velocity", "cap_pressure", "rod_pressure"] {
            if cylinder.chambers.is_some() || !signal.ends_with("pressure") {
                names.push(format!("{}.{signal}", cylinder.name));
            }
        }
    }
    if matches!(model.machine.supply, excavator_model::machine::Supply::PumpLine(_)) {
        names.push("pump_pressure".to_string());
    }
    let signals = names
        .into_iter()
        .filter_map(|name| {
            let (y, yhat) = (measured.signal(&name)?, simulated.signal(&name)?);
            if !is_measured(y) {
                return None;
            }
            let normalised_error = normalised_mean_squared_error(y, yhat);
            Some(SignalComparison {
                phase_delay_degrees: excitation_frequency
                    .and_then(|frequency| phase_delay_degrees(&recording.time, y, yhat, frequency)),
                fit: fit_percent(normalised_error),
                normalised_error,
                name,
            })
        })
        .collect();
    Ok(Comparison { measured, simulated, signals, excitation_frequency })
}
