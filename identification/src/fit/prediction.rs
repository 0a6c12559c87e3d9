//! Predicts one step of a fit without taking it.

use std::ops::ControlFlow;

use excavator_model::Model;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::DVector;

use super::normal_equations::RawSums;
use super::output_error::run;
use super::problem::Problem;
use super::step::{bounded_step, error_sizes, held_at_bounds, loss_per_reading, parameter_step};
use super::{Fit, FitError, FitSettings};

/// Prediction of a Gauss-Newton step from a model's parameters.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// Loss of the model at its present parameters and measured initial states; see [`super::Fit::loss`].
    pub loss_before: f64,
    /// Loss after the step if the outputs were linear in parameters and initial states.
    pub loss_after: f64,
    /// The model after the step, within the parameters' bounds.
    pub model: Model,
    /// The simulation of the model at its present parameters.
    pub(super) sums: Vec<RawSums>,
}

/// Simulates once with sensitivities, and predicts a step of all unknown parameters.
///
/// # Errors
/// [`FitError`].
pub fn predict(model: &Model, recordings: &[&Recording], settings: &FitSettings) -> Result<Prediction, FitError> {
    let system = System::new(model);
    let problem = Problem::new(model, &system, recordings, settings, model.unknown_parameters())?;
    let values = model.parameter_values();
    let raw = problem.sums_at(&values, &problem.segments)?;
    let weights = error_sizes(&raw, &problem.noise);
    let loss_before = loss_per_reading(&weights, &problem.noise);
    let sums = problem.weighed_with_priors(&raw, &weights, &values);
    let held = held_at_bounds(&sums, &values, &problem.fitted, &problem.priors.bounds);
    let (stepped, taken) = match parameter_step(&sums, &held, DAMPING) {
        Some(step) => bounded_step(
            &values,
            &step,
            &problem.fitted,
            &problem.scales,
            &problem.cards,
            &problem.priors.bounds,
            problem.longest_shift(),
        ),
        None => (values, DVector::zeros(problem.fitted.len())),
    };
    let mut squares = vec![0.0; problem.noise.len()];
    let mut counts = vec![0usize; problem.noise.len()];
    for (raw, sums) in raw.iter().zip(&sums) {
        let state_step = sums.state_step(&taken, DAMPING);
        raw.add_predicted(&taken, &state_step, &problem.noise, &mut squares);
        for (total, count) in counts.iter_mut().zip(raw.counts()) {
            *total += count;
        }
    }
    let errors: Vec<f64> = squares
        .iter()
        .zip(&counts)
        .zip(&problem.noise)
        .map(|((squares, &count), noise)| (squares / count.max(1) as f64).max(0.0).sqrt().max(*noise))
        .collect();
    let mut model = model.clone();
    model.set_parameter_values(&stepped);
    Ok(Prediction { loss_before, loss_after: loss_per_reading(&errors, &problem.noise), model, sums: raw })
}

/// Like [`super::fit`], but reuses the simulation in `predicted`. That must be of the same model and recordings, cut
/// and thinned by the same settings.
///
/// # Errors
/// [`FitError`].
pub(crate) fn fit_predicted(
    model: &Model,
    predicted: Prediction,
    recordings: &[&Recording],
    settings: &FitSettings,
) -> Result<Fit, FitError> {
    let (fitted, first) = (model.unknown_parameters(), Some(predicted.sums));
    run(model, recordings, settings, fitted, settings.maximum_steps, first, &|_| ControlFlow::Continue(()))
}

/// Levenberg-Marquardt damping of the predicted step, equal to that of a fit's first step.
const DAMPING: f64 = 1e-3;
