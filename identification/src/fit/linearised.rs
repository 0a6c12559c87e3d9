//! Outputs of a model, linearised in its own parameters and in further ones that it could have.

use excavator_model::Model;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::DVector;

use super::normal_equations::{RawSums, SegmentSums};
use super::problem::Problem;
use super::step::{error_sizes, loss_per_reading, parameter_step};
use super::{FitError, FitSettings};

/// One simulation with sensitivities, that predicts steps in any choice of further parameters.
pub(crate) struct Linearised {
    raw: Vec<RawSums>,
    sums: Vec<SegmentSums>,
    noise: Vec<f64>,
    scales: Vec<f64>,
    /// Values of the model's own free parameters, and their bounds.
    own: Vec<(f64, [f64; 2])>,
    /// Loss of the model as it is, after a step of its own parameters; see [`super::Fit::loss`].
    pub loss_before: f64,
}

/// Predicted result of a step in some further parameters.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Promise {
    /// The chosen parameters after the step, in their units.
    pub values: Vec<f64>,
    /// The model's own free parameters after the step, within their bounds.
    pub own: Vec<f64>,
    /// Loss after the step, if the outputs were linear.
    pub loss: f64,
}

/// Levenberg-Marquardt damping of the predicted step. It only guards against parameters that the recordings do not
/// show.
const DAMPING: f64 = 1e-6;

impl Linearised {
    /// Linearises `model` in its own parameters `own` and in the `further` ones, which are zero.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn new(
        model: &Model,
        own: &[usize],
        further: &[usize],
        recordings: &[&Recording],
        settings: &FitSettings,
    ) -> Result<Linearised, FitError> {
        let system = System::new(model);
        let fitted: Vec<usize> = own.iter().chain(further).copied().collect();
        let problem = Problem::new(model, &system, recordings, settings, fitted)?;
        let values = model.parameter_values();
        let raw = problem.sums_at(&values, &problem.segments)?;
        let weights = error_sizes(&raw, &problem.noise);
        let sums = problem.weighed_with_priors(&raw, &weights, &values);
        let Problem { noise, scales, priors, .. } = problem;
        let own = own.iter().map(|&index| (values[index], priors.bounds[index])).collect();
        let mut linearised = Linearised { raw, sums, noise, scales, own, loss_before: f64::NAN };
        linearised.loss_before = linearised.promise(&[]).map_or(f64::INFINITY, |promise| promise.loss);
        Ok(linearised)
    }

    /// Predicts a step of the model's own parameters and of the `chosen` further ones, which are given by their
    /// indices. Returns `None` if the recordings do not separate them.
    pub fn promise(&self, chosen: &[usize]) -> Option<Promise> {
        let own = self.own.len();
        let held: Vec<bool> =
            (0..self.scales.len()).map(|number| number >= own && !chosen.contains(&(number - own))).collect();
        let step: DVector<f64> = parameter_step(&self.sums, &held, DAMPING)?;
        let (mut squares, mut counts) = (vec![0.0; self.noise.len()], vec![0usize; self.noise.len()]);
        for (raw, sums) in self.raw.iter().zip(&self.sums) {
            raw.add_predicted(&step, &sums.state_step(&step, DAMPING), &self.noise, &mut squares);
            counts.iter_mut().zip(raw.counts()).for_each(|(total, count)| *total += count);
        }
        let errors: Vec<f64> = squares
            .iter()
            .zip(&counts)
            .map(|(squares, &count)| (squares / count.max(1) as f64).max(0.0).sqrt())
            .zip(&self.noise)
            .map(|(error, noise)| error.max(LEAST_ERROR * noise))
            .collect();
        let values = chosen.iter().map(|&number| step[own + number] * self.scales[own + number]).collect();
        let stepped = self.own.iter().zip(step.iter().zip(&self.scales));
        let own =
            stepped.map(|((value, [lowest, highest]), (step, scale))| (value + step * scale).clamp(*lowest, *highest));
        Some(Promise { values, own: own.collect(), loss: loss_per_reading(&errors, &self.noise) })
    }
}

/// Smallest error of an instrument in units of its noise, which is itself an estimate. A smaller prediction is an
/// artefact of the linearisation.
const LEAST_ERROR: f64 = 0.7;
