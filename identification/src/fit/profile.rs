//! Profile likelihood: confidence intervals of parameters for which a standard error is not reliable.
//!
//! The parameter is moved away from its best value step by step, and all others are fitted again. The interval ends
//! where the outputs fit significantly worse (Raue et al. 2009). Unlike a standard error, this is valid at bounds,
//! where a coefficient cannot be negative, and far from the best value. If no end is found, the parameter is not
//! identifiable.

use excavator_model::recording::Recording;

use super::output_error::fit;
use super::{Fit, FitError, FitSettings};

/// Profile of one parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileInterval {
    /// Index of the parameter in the model's order.
    pub index: usize,
    /// Lower end of the 95 % interval; `None` if every value down to the minimum fits as well.
    pub lower: Option<f64>,
    /// Upper end; `None` if every value up to the maximum fits as well.
    pub upper: Option<f64>,
    /// The parameter that compensates for it most: index in the model's order, and correlation.
    pub companion: Option<(usize, f64)>,
}

impl ProfileInterval {
    /// Whether the recordings bound it on either side.
    pub fn is_identifiable(&self) -> bool {
        self.lower.is_some() || self.upper.is_some()
    }
}

/// 95 % quantile of chi-square with one degree of freedom.
const THRESHOLD: f64 = 3.841;
/// Steps of each fit. It starts at the solution for a nearby value.
const STEPS: usize = 5;
/// Doublings of the distance before a side counts as unbounded.
const DOUBLINGS: usize = 12;
/// Smallest correlation at which another parameter is named as compensating for it.
const TOGETHER: f64 = 0.7;

/// Profiles parameter `index` (in the model's order). `best` is a fit of it and others to `recordings`.
///
/// # Errors
/// [`FitError`] if the recordings cannot be fitted at all.
pub fn profile(
    best: &Fit,
    recordings: &[&Recording],
    settings: &FitSettings,
    index: usize,
) -> Result<ProfileInterval, FitError> {
    // The best model is fitted again with the settings of the profile, so that the compared fits have the same
    // settings.
    let best = fit(&best.model, recordings, &FitSettings { maximum_steps: STEPS, ..*settings })?;
    let settings = FitSettings { maximum_steps: STEPS, least_improvement: 1e-6, ..*settings };
    let side = |direction: f64| end_of(&best, recordings, &settings, index, direction);
    Ok(ProfileInterval { index, lower: side(-1.0), upper: side(1.0), companion: companion(&best, index) })
}

/// The value in one direction at which the outputs fit significantly worse.
fn end_of(best: &Fit, recordings: &[&Recording], settings: &FitSettings, index: usize, direction: f64) -> Option<f64> {
    let parameters: Vec<_> = best.model.parameters().map(|(_, parameter)| parameter).collect();
    let parameter = parameters.get(index)?;
    let (start, card) = (parameter.value, parameter.card.clone());
    let own = best.fitted.iter().position(|&fitted| fitted == index)?;
    let inflation = best.inflation.get(own).copied().filter(|factor| factor.is_finite()).unwrap_or(1.0).max(1.0);
    let error = parameter.standard_error.filter(|error| error.is_finite() && *error > 0.0);
    let mut distance = error.unwrap_or(0.1 * card.typical.abs());
    let mut model = best.model.clone();
    model.parameters_mut().nth(index)?.known = true;
    // Square root of the deviance. It is proportional to the distance if the model is linear.
    let mut before = (start, 0.0);
    for _ in 0..DOUBLINGS {
        let value = (start + direction * distance).clamp(card.minimum, card.maximum);
        if value == before.0 {
            return None;
        }
        model.parameters_mut().nth(index)?.value = value;
        // A value at which the simulation fails is outside the interval.
        let Ok(fitted) = fit(&model, recordings, settings) else { return Some(before.0) };
        let root = (deviance(best, &fitted) / (inflation * THRESHOLD)).max(0.0).sqrt();
        if root >= 1.0 {
            let share = (1.0 - before.1) / (root - before.1);
            return Some(before.0 + share * (value - before.0));
        }
        model = fitted.model;
        model.parameters_mut().nth(index)?.known = true;
        before = (value, root.max(before.1));
        distance *= 2.0;
    }
    None
}

/// Growth of the sum of squared errors from the first fit to the second, in units of the first one's error variance.
fn deviance(best: &Fit, other: &Fit) -> f64 {
    let totals = |fit: &Fit, instrument: usize| fit.squares_of(instrument, 0..fit.block_errors.len());
    best.instruments
        .iter()
        .enumerate()
        .map(|(number, instrument)| {
            let ((best, count), (other, _)) = (totals(best, number), totals(other, number));
            let variance = (best / count.max(1) as f64).max(instrument.noise.powi(2));
            (other - best) / variance
        })
        .sum()
}

fn companion(fit: &Fit, index: usize) -> Option<(usize, f64)> {
    let own = fit.fitted.iter().position(|&fitted| fitted == index)?;
    let correlation = |other: usize| {
        let covariance = &fit.covariance;
        covariance[(own, other)] / (covariance[(own, own)] * covariance[(other, other)]).sqrt()
    };
    (0..fit.fitted.len())
        .filter(|&other| other != own)
        .map(|other| (fit.fitted[other], correlation(other)))
        .filter(|(_, correlation)| correlation.is_finite() && correlation.abs() >= TOGETHER)
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
}
