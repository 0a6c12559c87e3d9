//! Predicts the error after a refit to recordings from one simulation with sensitivities of each recording.

use excavator_model::Model;
use excavator_model::equations::System;
use excavator_model::recording::Recording;
use nalgebra::{DMatrix, DVector};

use super::normal_equations::RawSums;
use super::problem::Problem;
use super::step::{LONGEST_SHIFT, bounded_step, held_at_bounds, parameter_step, scales};
use super::{FitError, FitSettings, Instrument};

/// Normal equations of a model, linearised at its present values, on one recording. Equations of several recordings add
/// up, so that a refit to any choice of them needs no further simulation.
#[derive(Debug, Clone)]
pub(crate) struct LinearRefit {
    raw: Vec<RawSums>,
    noise: Vec<f64>,
}

/// Error that remains on a noise-free recording after a refit, by instrument.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Remainder {
    /// Sum of squared errors, in units of the instrument's noise variance.
    pub squares: Vec<f64>,
    /// Number of readings.
    pub counts: Vec<usize>,
}

/// Relative damping of the step, just enough to hold directions that no recording shows.
const DAMPING: f64 = 1e-6;
/// Rounds in which instruments are weighted by their remaining errors
const ROUNDS: usize = 3;

impl LinearRefit {
    /// Simulates `model` on a recording without noise. `noise` is the standard deviation of each instrument's noise in
    /// a real recording, in its unit.
    ///
    /// # Errors
    /// [`FitError`].
    pub fn new(
        model: &Model,
        recording: &Recording,
        settings: &FitSettings,
        noise: &dyn Fn(&Instrument) -> f64,
    ) -> Result<Self, FitError> {
        let system = System::new(model);
        let mut problem = Problem::new(model, &system, &[recording], settings, model.unknown_parameters())?;
        for (instrument, slot) in problem.instruments.iter_mut().zip(&mut problem.noise) {
            instrument.noise = noise(instrument);
            *slot = instrument.noise;
        }
        let raw = problem.sums_at(&model.parameter_values(), &problem.segments)?;
        Ok(LinearRefit { raw, noise: problem.noise })
    }

    /// The error that would remain after a refit of `model` to all `parts` together.
    pub fn remainder(model: &Model, parts: &[&LinearRefit]) -> Remainder {
        let Some(noise) = parts.first().map(|part| &part.noise) else {
            return Remainder { squares: Vec::new(), counts: Vec::new() };
        };
        let raw: Vec<&RawSums> = parts.iter().flat_map(|part| &part.raw).collect();
        let Free { fitted, scales } = Free::of(model);
        let values = model.parameter_values();
        let cards: Vec<_> = model.parameters().map(|(_, parameter)| parameter.card.clone()).collect();
        let bounds: Vec<[f64; 2]> = cards.iter().map(|card| [card.minimum, card.maximum]).collect();
        let mut counts = vec![0; noise.len()];
        for sums in &raw {
            for (total, count) in counts.iter_mut().zip(sums.counts()) {
                *total += count;
            }
        }
        let longest_shift = LONGEST_SHIFT * model.machine.size().time();
        let mut factors = vec![1.0; noise.len()];
        let mut squares = vec![0.0; noise.len()];
        for _ in 0..ROUNDS {
            let sums: Vec<_> = raw.iter().map(|segment| segment.weighed(&factors)).collect();
            let held = held_at_bounds(&sums, &values, &fitted, &bounds);
            let taken = parameter_step(&sums, &held, DAMPING).map_or_else(
                || DVector::zeros(fitted.len()),
                |step| bounded_step(&values, &step, &fitted, &scales, &cards, &bounds, longest_shift).1,
            );
            squares = vec![0.0; noise.len()];
            for (raw, sums) in raw.iter().zip(&sums) {
                raw.add_predicted(&taken, &sums.state_step(&taken, DAMPING), noise, &mut squares);
            }
            for ((slot, noise), (factor, &count)) in squares.iter_mut().zip(noise).zip(factors.iter_mut().zip(&counts))
            {
                *slot = (*slot / (noise * noise)).max(0.0);
                *factor = 1.0 / (1.0 + *slot / count.max(1) as f64);
            }
        }
        Remainder { squares, counts }
    }

    /// Information (inverse covariance) of the unknown parameters of `model`, each in units of its scale, for sensor
    /// noise alone. Initial states are eliminated. [`scales`] returns the scales.
    pub fn information(model: &Model, parts: &[&LinearRefit]) -> DMatrix<f64> {
        let count = model.unknown_parameters().len();
        let mut information = DMatrix::zeros(count, count);
        for part in parts {
            let factors = vec![1.0; part.noise.len()];
            for segment in &part.raw {
                information += segment.weighed(&factors).information;
            }
        }
        information
    }
}

impl Remainder {
    /// Logarithm of the likelihood ratio between the truth and the refitted model: half the sum over instruments of `n
    /// ln(1 + mean square)`, with errors of unknown size as in [`super::Fit::loss`].
    pub fn log_likelihood_ratio(&self) -> f64 {
        let each = self.squares.iter().zip(&self.counts);
        0.5 * each.map(|(squares, &count)| count as f64 * (1.0 + squares / count.max(1) as f64).ln()).sum::<f64>()
    }

    /// By how much the loss ([`super::Fit::loss`]) of the refitted model exceeds that of the truth.
    pub fn gain(&self) -> f64 {
        let seen: Vec<f64> = self
            .squares
            .iter()
            .zip(&self.counts)
            .filter(|&(_, &count)| count > 0)
            .map(|(squares, &count)| (1.0 + squares / count as f64).ln())
            .collect();
        if seen.is_empty() { 0.0 } else { seen.iter().sum::<f64>() / seen.len() as f64 }
    }

    /// Distance from the truth in standard deviations of sensor noise: square root of the sum of squares.
    pub fn distance(&self) -> f64 {
        self.squares.iter().sum::<f64>().sqrt()
    }
}

/// Indices of the unknown parameters and their scales.
struct Free {
    fitted: Vec<usize>,
    scales: Vec<f64>,
}

impl Free {
    fn of(model: &Model) -> Self {
        let fitted = model.unknown_parameters();
        let scales = scales(model, &fitted);
        Free { fitted, scales }
    }
}
