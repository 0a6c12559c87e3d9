//! Information that a stretch of a recording contains about the parameters, before any fit.

use excavator_model::Model;
use excavator_model::effects::Family;
use excavator_model::equations::System;
use excavator_model::machine::Linkage;
use excavator_model::recording::Recording;
use excavator_model::simulation::undistorted;
use nalgebra::DMatrix;

use super::equation::equations;
use super::sensor_noise::SensorNoise;
use super::sensor_noise::sensor_noise;
use super::simulated::simulated;
use super::weak_row::weak_row;
use super::weak_rows::moves;
use super::window::windows;
use super::{RegressionError, WeakFormSettings, observe};

/// Sample rate at which information is computed, on a machine of the reference size. An order of magnitude is enough to
/// choose between stretches, and the full rate of a recorder would cost ten times as much.
const RATE: f64 = 100.0;

/// Data that are the same for all stretches.
pub(crate) struct Gauge<'m> {
    model: &'m Model,
    unknown: Vec<usize>,
    /// Size of each unknown parameter, in its unit.
    sizes: Vec<f64>,
    linkages: Vec<Linkage>,
    noise: SensorNoise,
}

/// Lower bound of an instrument's noise, as a share of the stroke or of the full opening.
const LEAST_SHARE: f64 = 1e-4;

/// Lower bound of a pressure sensor's noise, Pa.
const LEAST_PRESSURE: f64 = 1e3;

/// Raises noise to at least that of good instruments. The noise-free signals of a simulation, or of a machine at rest,
/// are not infinitely certain.
fn at_least(mut noise: SensorNoise, model: &Model) -> SensorNoise {
    noise.pump_pressure = noise.pump_pressure.max(LEAST_PRESSURE);
    for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
        noise.displacement[number] = noise.displacement[number].max(LEAST_SHARE * cylinder.usual_travel());
        noise.pressures[number].iter_mut().for_each(|own| *own = own.max(LEAST_PRESSURE));
        let full = cylinder.chambers.as_ref().map_or(0.0, |oil| oil.full_command());
        noise.spool[number] = noise.spool[number].max(LEAST_SHARE * full);
    }
    noise
}

impl<'m> Gauge<'m> {
    /// A gauge for the unknown parameters of `model`. Noise is estimated from `recording`: a stretch in which nothing
    /// moves shows less.
    ///
    /// # Errors
    /// [`RegressionError`] if the recording lacks a cylinder of the model.
    pub fn new(model: &'m Model, recording: &Recording) -> Result<Self, RegressionError> {
        let cards: Vec<_> = model.parameters().collect();
        let is_told = |index: &usize| model.effects[cards[*index].0].physics.card().family != Family::Rounding;
        let unknown: Vec<usize> = model.unknown_parameters().into_iter().filter(is_told).collect();
        let size = |index: &usize| {
            let parameter = cards[*index].1;
            if parameter.value == 0.0 { parameter.card.typical.abs() } else { parameter.value.abs() }
        };
        Ok(Gauge {
            model,
            sizes: unknown.iter().map(size).collect(),
            unknown,
            linkages: model.machine.cylinders.iter().map(|cylinder| cylinder.linkage).collect(),
            noise: at_least(sensor_noise(recording, model)?, model),
        })
    }

    /// Number of parameters.
    pub fn parameters(&self) -> usize {
        self.unknown.len()
    }

    /// Information matrix of a stretch about the parameters, each in units of its size. Its inverse is the covariance
    /// of relative errors from sensor noise.
    ///
    /// # Errors
    /// [`RegressionError`] if the stretch lacks inputs.
    pub fn information(&self, stretch: &Recording) -> Result<DMatrix<f64>, RegressionError> {
        let model = self.model;
        let rate = RATE / model.machine.size().time();
        let stride = (1.0 / (stretch.sample_interval() * rate)).floor().max(1.0);
        let thin = stretch.thinned(if stride.is_finite() { stride as usize } else { 1 });
        let truth = undistorted(model, &thin);
        let has_states = model.effects.iter().any(|effect| effect.physics.states() > 0);
        let effect_states = if has_states { simulated(model, &thin, &truth)?.effect_states } else { Vec::new() };
        let observation = observe(model, &truth)?;
        let equations = equations(&System::new(model), &observation, &effect_states, &self.unknown);
        let settings = WeakFormSettings::default();
        let (half_width, _) = settings.widths(model, &[&thin]);
        let mut information = DMatrix::zeros(self.parameters(), self.parameters());
        // Adjacent windows only: those in between add rows but hardly any information.
        for window in windows(&thin.time, thin.sample_interval(), half_width, half_width) {
            for equation in &equations {
                if !moves(equation.kind, &window, &observation, settings.velocity_guard) {
                    continue;
                }
                let row = weak_row(equation, &window, &observation, &self.noise, &self.linkages, self.parameters());
                let Some(row) = row.filter(|row| row.regressors.iter().all(|slope| slope.is_finite())) else {
                    continue;
                };
                let mut scaled = row.regressors;
                scaled.iter_mut().zip(&self.sizes).for_each(|(slope, size)| *slope *= size / row.noise);
                information.ger(1.0, &scaled, &scaled, 1.0);
            }
        }
        Ok(information)
    }
}
