//! Multiple-shooting output-error fit by Gauss-Newton steps with Levenberg-Marquardt damping.
//!
//! It does not use a general least-squares crate, because each segment's initial state is eliminated from the normal
//! equations before they are added up. A general solver would factor one dense Jacobian with a column for each initial
//! state of each segment.

use std::ops::ControlFlow;

use excavator_model::Model;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::DMatrix;

use super::covariance::clustered_covariance;
use super::normal_equations::{RawSums, SegmentSums};
use super::problem::Problem;
use super::step::{bounded_step, error_sizes, held_at_bounds, loss_per_reading, parameter_step};
use super::trial::loss_of;
use super::{FitError, FitSettings, Instrument, Watch};

/// Result of a fit.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The model with the fitted parameters and their standard errors.
    pub model: Model,
    /// Indices of the fitted parameters, in the model's order.
    pub fitted: Vec<usize>,
    /// Covariance of the fitted parameters, in their units.
    pub covariance: DMatrix<f64>,
    /// Ratio of the variance of each fitted parameter to its variance for white errors.
    pub inflation: Vec<f64>,
    /// What was compared.
    pub instruments: Vec<Instrument>,
    /// Root mean square error of each instrument, in its unit.
    pub errors: Vec<f64>,
    /// Sum of squared errors and number of readings per block of half a second and instrument.
    pub block_errors: Vec<Vec<(f64, usize)>>,
    /// Recording of each block, and its start in s after the recording's first sample.
    pub block_places: Vec<(usize, f64)>,
    /// Gauss-Newton steps taken.
    pub steps: usize,
    /// Whether the last step was too small to matter.
    pub converged: bool,
}

impl Fit {
    /// Logarithmic loss: mean over instruments of `ln(mean squared error / noise variance)`, half of minus the
    /// concentrated log-likelihood per reading. It is zero if only noise is left.
    pub fn loss(&self) -> f64 {
        let noise: Vec<f64> = self.instruments.iter().map(|instrument| instrument.noise).collect();
        loss_per_reading(&self.errors, &noise)
    }

    /// Sum of squared errors of an instrument over some of the blocks, and the number of its readings there.
    pub(crate) fn squares_of(&self, instrument: usize, blocks: impl Iterator<Item = usize>) -> (f64, usize) {
        blocks
            .filter_map(|block| self.block_errors.get(block)?.get(instrument))
            .fold((0.0, 0), |(squares, count), (own, readings)| (squares + own, count + readings))
    }

    /// Indices of the fitted parameters whose 95 % intervals include zero: not even their sign is known.
    pub fn undetermined(&self) -> Vec<usize> {
        let parameters: Vec<_> = self.model.parameters().map(|(_, parameter)| parameter).collect();
        let unknown = |&&index: &&usize| {
            let parameter = parameters[index];
            parameter.margin_95.is_none_or(|margin| margin.is_nan() || margin >= parameter.value.abs())
        };
        self.fitted.iter().filter(unknown).copied().collect()
    }
}

/// Fits the unknown parameters of `model` to `recordings`, starting from its values.
///
/// Errors of each instrument are divided by their RMS value in the previous step (never less than its noise). For a
/// wrong model this is the maximum-likelihood weighting for errors of unknown size.
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
/// // The regression gives the fit a good start.
/// let start = weak_form(&given, &[&recording], &WeakFormSettings::default())?;
/// let found = fit(&start.model, &[&recording], &FitSettings::default())?;
/// let gain = found.model.value_of("arm.flow_gain_cap").ok_or("no such parameter")?;
/// assert!((gain / 4.6e-3 - 1.0).abs() < 0.02, "{gain} m/(s sqrt(Pa))");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`FitError`].
pub fn fit(model: &Model, recordings: &[&Recording], settings: &FitSettings) -> Result<Fit, FitError> {
    fit_watched(model, recordings, settings, &|_| ControlFlow::Continue(()))
}

/// Like [`fit`], but calls `watch` before each step and stops when it returns a break.
///
/// # Errors
/// [`FitError`], among them [`FitError::Stopped`].
pub fn fit_watched(
    model: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
    watch: Watch<'_>,
) -> Result<Fit, FitError> {
    let fitted = model.unknown_parameters();
    run(model, recordings, settings, fitted, settings.maximum_steps, None, watch)
}

/// Errors of `model` on `recordings`. The parameters are held; only initial states are fitted.
///
/// # Errors
/// [`FitError`].
pub fn evaluate(model: &Model, recordings: &[&Recording], settings: &FitSettings) -> Result<Fit, FitError> {
    run(model, recordings, settings, Vec::new(), 4, None, &|_| ControlFlow::Continue(()))
}

struct State {
    values: Vec<f64>,
    /// One entry per segment, then those of the priors.
    sums: Vec<SegmentSums>,
    loss: f64,
}

/// Runs the steps of a fit of the parameters `fitted`. `first` is the simulation at the start values, if it is known.
pub(super) fn run(
    model: &Model,
    recordings: &[&Recording],
    settings: &FitSettings,
    fitted: Vec<usize>,
    maximum_steps: usize,
    first: Option<Vec<RawSums>>,
    watch: Watch<'_>,
) -> Result<Fit, FitError> {
    let system = System::new(model);
    let problem = Problem::new(model, &system, recordings, settings, fitted)?;
    let Problem { fitted, scales, cards, noise, .. } = &problem;
    let bounds = &problem.priors.bounds;
    let mut segments = problem.segments.clone();
    let mut values = model.parameter_values();
    if first.is_none() {
        // A start value may be outside the range of a prior, and no step leads back from there.
        for &index in fitted {
            let [lowest, highest] = bounds[index];
            values[index] = values[index].clamp(lowest, highest);
        }
    }
    let raw = first.map_or_else(|| problem.sums_at(&values, &segments), Ok)?;
    let mut weights = error_sizes(&raw, noise);
    let sums = problem.weighed_with_priors(&raw, &weights, &values);
    let loss = loss_of(&sums, &weights);
    let mut current = State { values, sums, loss };
    let mut damping = 1e-3;
    let mut steps = 0;
    let mut converged = false;
    let longest_shift = problem.longest_shift();
    while steps < maximum_steps {
        if watch(steps as f64 / maximum_steps as f64).is_break() {
            return Err(FitError::Stopped);
        }
        steps += 1;
        let held = held_at_bounds(&current.sums, &current.values, fitted, bounds);
        let Some(step) = parameter_step(&current.sums, &held, damping) else { break };
        let (trial_values, taken) = bounded_step(&current.values, &step, fitted, scales, cards, bounds, longest_shift);
        let mut trial = segments.clone();
        for (segment, sums) in trial.iter_mut().zip(&current.sums) {
            let change = sums.state_step(&taken, damping);
            for (value, change) in segment.state.iter_mut().zip(change.iter()) {
                *value += change;
            }
        }
        let Some(reached) = problem.tried(&trial_values, trial, (&segments, &current.sums), &weights) else {
            damping = (damping * 10.0_f64).max(1e-3);
            if damping > 1e6 {
                break;
            }
            continue;
        };
        let improvement = (current.loss - reached.loss) / current.loss.max(f64::MIN_POSITIVE);
        let raw = reached.raw;
        segments = reached.segments;
        let new_weights = error_sizes(&raw, noise);
        let reweighting = new_weights.iter().zip(&weights).map(|(new, old)| (new / old).ln().abs()).fold(0.0, f64::max);
        let remaining = loss_per_reading(&new_weights, noise);
        weights = new_weights;
        let sums = problem.weighed_with_priors(&raw, &weights, &trial_values);
        let loss = loss_of(&sums, &weights);
        current = State { values: trial_values, sums, loss };
        damping = (damping / 10.0).max(1e-9);
        if steps >= 4 && remaining > settings.give_up_above {
            break;
        }
        if improvement < settings.least_improvement && reweighting <= 0.05 {
            converged = true;
            break;
        }
    }
    Ok(result(model, problem, current, steps, converged))
}

fn result(model: &Model, problem: Problem<'_, '_>, state: State, steps: usize, converged: bool) -> Fit {
    let block_places = problem.block_places(&state.sums);
    let Problem { fitted, scales, instruments, .. } = problem;
    let (covariance, inflation) = clustered_covariance(&state.sums, &scales);
    let mut model = model.clone();
    model.set_parameter_values(&state.values);
    for (index, parameter) in model.parameters_mut().enumerate() {
        if let Some(number) = fitted.iter().position(|&candidate| candidate == index) {
            let variance = covariance[(number, number)];
            let error = variance.max(0.0).sqrt();
            parameter.standard_error = Some(error);
            parameter.margin_95 = Some(1.96 * error);
        }
    }
    let errors = instruments
        .iter()
        .enumerate()
        .map(|(number, _)| {
            let squares: f64 = state.sums.iter().map(|segment| segment.squared_errors[number]).sum();
            let count: usize = state.sums.iter().map(|segment| segment.counts[number]).sum();
            (squares / count.max(1) as f64).sqrt()
        })
        .collect();
    let block_errors = state.sums.iter().flat_map(|segment| segment.block_errors.iter().cloned()).collect();
    Fit { model, fitted, covariance, inflation, instruments, errors, block_errors, block_places, steps, converged }
}
