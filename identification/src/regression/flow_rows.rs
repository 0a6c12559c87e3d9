//! The flow balances of chambers and pump line in the weak form, with motion, pressures and openings as measured.
//!
//! No balance can pay for what another one lacks, because each sees the other through measurements only.

use excavator_model::equations::System;
use excavator_model::machine::Linkage;
use excavator_model::recording::Recording;
use excavator_model::simulation::undistorted;
use excavator_model::{Imposed, Model};
use nalgebra::DMatrix;

use super::equation::{Equation, EquationKind, equations_by};
use super::sensor_noise::{SensorNoise, sensor_noise};
use super::simulated::simulated;
use super::weak_row::weak_row;
use super::window::{Window, windows};
use super::{Observation, RegressionError, observe};

/// Half width of a test function, s, on a machine of the reference size. Noise of the signals enters products of them, and a
/// short window does not average it out: at 100 Hz with 12 bits, windows of half this width select wrong effects.
const HALF_WIDTH: f64 = 0.075;

/// Smallest number of samples in half a window.
const LEAST_SAMPLES: f64 = 6.0;

/// Distance between windows as a share of their half width.
const STEP: f64 = 1.0 / 3.0;

/// Samples per second to which recordings are averaged, on a machine of the reference size: nine in half a window.
const RATE: f64 = 125.0;

/// Step of a difference quotient, as a share of the typical size of a parameter.
const DIFFERENCE: f64 = 1e-3;

/// Recordings prepared for the flow balances of models that differ in their effects.
pub(crate) struct FlowGround {
    each: Vec<Measured>,
}

struct Measured {
    recording: Recording,
    observation: Observation,
    noise: SensorNoise,
    windows: Vec<Window>,
}

/// Rows of the flow balances.
#[derive(Debug, Clone)]
pub(crate) struct FlowRows {
    /// Equation of each row.
    pub kinds: Vec<EquationKind>,
    /// Residual of each row, m³.
    pub residuals: Vec<f64>,
    /// Standard deviation of its noise from the storage terms, m³.
    pub noise: Vec<f64>,
    /// Its derivative by each unknown parameter.
    pub regressors: DMatrix<f64>,
}

impl FlowGround {
    /// Prepares recordings. Instruments are read as `model` has them.
    ///
    /// # Errors
    /// [`RegressionError`] if inputs are missing.
    pub fn new(model: &Model, recordings: &[&Recording]) -> Result<Self, RegressionError> {
        let time_scale = model.machine.size().time();
        let averaged = |recording: &Recording| {
            let count = (time_scale / (RATE * recording.sample_interval())).round();
            undistorted(model, recording).averaged(if count.is_finite() { (count as usize).max(1) } else { 1 })
        };
        let recordings: Vec<Recording> = recordings.iter().map(|recording| averaged(recording)).collect();
        let slowest = recordings.iter().map(Recording::sample_interval).fold(0.0, f64::max);
        let half_width = (HALF_WIDTH * time_scale).max(LEAST_SAMPLES * slowest);
        let measured = |recording: Recording| {
            Ok(Measured {
                observation: observe(model, &recording)?.with_measured_pressures(),
                noise: sensor_noise(&recording, model)?,
                windows: windows(&recording.time, recording.sample_interval(), half_width, half_width * STEP),
                recording,
            })
        };
        Ok(FlowGround { each: recordings.into_iter().map(measured).collect::<Result<_, RegressionError>>()? })
    }

    /// Rows of all flow balances of `model`, with derivatives by the parameters with indices `unknown`.
    ///
    /// # Errors
    /// [`RegressionError`] if states of effects cannot be simulated.
    pub fn rows(&self, model: &Model, unknown: &[usize]) -> Result<FlowRows, RegressionError> {
        let mut rows = self.direct_rows(model, unknown)?;
        // States of effects depend on parameters too, and only a second evaluation shows how.
        let values = model.parameter_values();
        for (column, &index) in unknown.iter().enumerate() {
            let Some((effect, parameter)) = model.parameters().nth(index) else { continue };
            if model.effects[effect].physics.states() == 0 {
                continue;
            }
            let step = DIFFERENCE * parameter.card.typical;
            let mut moved = model.clone();
            let mut others = values.clone();
            others[index] += step;
            moved.set_parameter_values(&others);
            let there = self.direct_rows(&moved, &[])?;
            for (row, (after, before)) in there.residuals.iter().zip(&rows.residuals).enumerate() {
                rows.regressors[(row, column)] = (after - before) / step;
            }
        }
        Ok(rows)
    }

    fn direct_rows(&self, model: &Model, unknown: &[usize]) -> Result<FlowRows, RegressionError> {
        let linkages: Vec<Linkage> = model.machine.cylinders.iter().map(|cylinder| cylinder.linkage).collect();
        let (mut kinds, mut residuals, mut noise, mut regressors) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for one in &self.each {
            let equations = one.equations(model, unknown)?;
            for window in &one.windows {
                for equation in &equations {
                    let row = weak_row(equation, window, &one.observation, &one.noise, &linkages, unknown.len());
                    let Some(row) = row else { continue };
                    kinds.push(equation.kind);
                    residuals.push(row.residual);
                    noise.push(row.noise);
                    regressors.extend(row.regressors.iter());
                }
            }
        }
        let regressors = DMatrix::from_row_slice(kinds.len(), unknown.len(), &regressors);
        Ok(FlowRows { kinds, residuals, noise, regressors })
    }
}

impl Measured {
    fn equations(&self, model: &Model, unknown: &[usize]) -> Result<Vec<Equation>, RegressionError> {
        let has_states = model.effects.iter().any(|effect| effect.physics.states() > 0);
        let states = if has_states {
            let held = Model { imposed: Imposed::Everything, ..model.clone() };
            simulated(&held, &self.recording, &self.recording)?.effect_states
        } else {
            Vec::new()
        };
        let mut equations = equations_by(&System::new(model), &self.observation, &states, unknown, &[]);
        equations.retain(|equation| !matches!(equation.kind, EquationKind::Motion(_)));
        Ok(equations)
    }
}
