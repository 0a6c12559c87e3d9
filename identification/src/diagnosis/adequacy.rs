//! Whether a model is as good as its recordings.

use excavator_model::recording::{Recording, standard_deviation};

use super::DiagnosisSettings;
use super::input_floor::with_input_floor;
use crate::fit::Fit;

/// Why nothing that could be named is missing in a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adequacy {
    /// What is left of the error is the noise of the sensors.
    Noise,
    /// What is left is a hundredth of each signal's own size.
    SmallError,
    /// What is left is no more than the readings of the inputs leave open.
    Inputs,
}

impl Adequacy {
    /// Name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Adequacy::Noise => "noise",
            Adequacy::SmallError => "small_error",
            Adequacy::Inputs => "inputs",
        }
    }
}

/// Noise, as a part of its spread, up to which a signal is clear: noise alone is no large error of it.
const CLEAR: f64 = 0.15;

/// Sample interval, s, from which on sensors look noisier than they are.
const COARSE: f64 = 0.03;

/// Whether what is left is noise but for a few moments, or too small to act on.
pub(super) fn adequacy(fit: &Fit, recordings: &[&Recording], settings: &DiagnosisSettings) -> Option<Adequacy> {
    let error = normalised_error(fit, recordings);
    // At such rates second differences, which the sensors' noise is taken from, have motion in them.
    let coarse = recordings.iter().any(|recording| recording.sample_interval() > COARSE);
    let too_large =
        mean_error(fit, recordings, CLEAR) > settings.largest_error || coarse && error > settings.excused_error;
    if fit.typical_loss() <= settings.adequate_loss && !too_large {
        return Some(Adequacy::Noise);
    }
    let is_small = error <= settings.adequate_error && fit.typical_loss() <= settings.small_error_loss;
    (is_small || error <= settings.negligible_error).then_some(Adequacy::SmallError)
}

/// Why a model as it is given is adequate, where it is; and whether it is not although the readings of the inputs leave as much open:
/// the recordings are too coarse to tell. For a model as it is given only; a name for what is missing asks for more.
pub(super) fn adequacy_as_given(
    fit: &Fit,
    recordings: &[&Recording],
    settings: &DiagnosisSettings,
) -> (Option<Adequacy>, bool) {
    let alone = adequacy(fit, recordings, settings);
    let inputs_explain = alone.is_none() && inputs_explain(fit, recordings, settings);
    let excused = inputs_explain && normalised_error(fit, recordings) <= settings.excused_error;
    (alone.or(excused.then_some(Adequacy::Inputs)), inputs_explain && !excused)
}

/// Whether what is left is no larger than the readings of the inputs leave open, in every instrument: what spoils the
/// pressures only is no excuse for the displacement.
fn inputs_explain(fit: &Fit, recordings: &[&Recording], settings: &DiagnosisSettings) -> bool {
    with_input_floor(fit, recordings, &settings.fit).is_some_and(|raised| is_within_floor(&raised, settings))
}

/// The same for a fit with effects that a model without them is compared with: these must take away at least the share `least` of
/// what `nominal` is off beyond that.
pub(super) fn inputs_explain_the_rest(
    fit: &Fit,
    nominal: &Fit,
    least: f64,
    recordings: &[&Recording],
    settings: &DiagnosisSettings,
) -> bool {
    if normalised_error(fit, recordings) > settings.excused_error {
        return false;
    }
    with_input_floor(fit, recordings, &settings.fit).is_some_and(|raised| {
        let nominal = Fit { instruments: raised.instruments.clone(), ..nominal.clone() };
        let share = 1.0 - raised.loss() / nominal.loss();
        nominal.loss() > settings.adequate_loss && share >= least && is_within_floor(&raised, settings)
    })
}

fn is_within_floor(raised: &Fit, settings: &DiagnosisSettings) -> bool {
    let worst = raised.typical_losses().into_iter().fold(f64::NEG_INFINITY, f64::max);
    raised.typical_loss() <= settings.adequate_loss && worst <= settings.excused_loss
}

/// Mean over instruments of squared error over the signal's own variance; `NaN` when no signal varies.
pub fn normalised_error(fit: &Fit, recordings: &[&Recording]) -> f64 {
    mean_error(fit, recordings, f64::INFINITY)
}

/// The same over the instruments whose noise is at most this part of their signal's spread.
fn mean_error(fit: &Fit, recordings: &[&Recording], most_noise: f64) -> f64 {
    let errors: Vec<f64> = fit
        .instruments
        .iter()
        .zip(&fit.errors)
        .filter_map(|(instrument, error)| {
            let signals = recordings.iter().filter_map(|recording| recording.signal(&instrument.name));
            let spread = signals.map(standard_deviation).fold(0.0, f64::max);
            (spread > 0.0 && instrument.noise <= most_noise * spread).then(|| (error / spread).powi(2))
        })
        .collect();
    errors.iter().sum::<f64>() / errors.len() as f64
}
