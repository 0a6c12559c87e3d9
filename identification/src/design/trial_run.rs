//! Trial runs: each rival in turn generates the recordings with noisy sensors, and all rivals are fitted to them, as in a
//! diagnosis.

use excavator_model::recording::Recording;
use excavator_model::simulation::Profile;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::ride::Rider;
use super::{DesignError, DesignSettings, Rival};
use crate::decision::{block_costs_of, improvement_on_blocks};
use crate::fit::{Fit, FitError, evaluate, fit};
use crate::nullable::Nullable;
use crate::search::{AdditionError, fit_addition, misfit, side};

/// One rival as the truth, and another one held against it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrialRun {
    /// Name of the rival that made the recordings.
    pub truth: String,
    /// Name of the rival that was fitted to them.
    pub other: String,
    /// By how much less the log error ratio of the truth is on the recording that was not fitted.
    #[serde(with = "Nullable")]
    pub improvement: f64,
    /// The same in its own standard errors.
    #[serde(with = "Nullable")]
    pub significance: f64,
}

/// Samples per second of the recordings, as with usual recorders.
const RATE: f64 = 500.0;

/// Two recordings of a rival under the profiles, from rest at mid-stroke, with independent noise.
///
/// # Errors
/// [`DesignError`] if the rival cannot be simulated.
pub(super) fn record(
    rival: &Rival,
    profiles: &[Profile],
    settings: &DesignSettings,
    stream: u64,
) -> Result<[Recording; 2], DesignError> {
    let rider = Rider::new(&rival.model);
    let machine = &rival.model.machine;
    let start = rider.at_rest(&vec![0.0; machine.cylinders.len()])?;
    let mut clean = rider.run_profiles(profiles, start, 0.0, RATE)?.recording;
    let layout = rider.system.layout();
    settings.sensors.hide_unmeasured(machine, layout, &mut clean);
    let mut generator = ChaCha8Rng::seed_from_u64(settings.seed);
    generator.set_stream(stream);
    let mut noisy = || {
        let mut recording = clean.clone();
        settings.sensors.disturb(machine, layout, &mut recording, &mut generator);
        recording
    };
    Ok([noisy(), noisy()])
}

/// Fits a rival to a recording from its own values and from the starts of a diagnosis, and returns the better fit.
///
/// # Errors
/// [`FitError`] if both fits fail.
pub(super) fn best_fit(rival: &Rival, recording: &Recording, settings: &DesignSettings) -> Result<Fit, FitError> {
    let own = fit(&rival.model, &[recording], &settings.fit);
    let Some(addition) = &rival.addition else { return own };
    let fresh = fit_addition(&rival.base(), addition, &[recording], &settings.fit);
    match (own, fresh) {
        (Ok(own), Ok(fresh)) => Ok(if fresh.loss() < own.loss() { fresh } else { own }),
        (Ok(one), Err(_)) | (Err(_), Ok(one)) => Ok(one),
        (Err(error), Err(AdditionError::Model(_))) => Err(error),
        (Err(_), Err(AdditionError::Fit(error))) => Err(error),
    }
}

/// Runs trials with every rival as the truth in turn, against every other.
///
/// # Errors
/// [`DesignError`].
pub(super) fn try_out(
    rivals: &[Rival],
    profiles: &[Profile],
    settings: &DesignSettings,
    progress: &(dyn Fn(&str, f64) + Sync),
) -> Result<Vec<TrialRun>, DesignError> {
    let mut trial_runs = Vec::new();
    let total = (rivals.len() * rivals.len()) as f64;
    for (number, truth) in rivals.iter().enumerate() {
        let [fitted, kept] = record(truth, profiles, settings, number as u64)?;
        let own = fit(&truth.model, &[&fitted], &settings.fit)?;
        let own = evaluate(&own.model, &[&kept], &settings.fit)?;
        for (index, other) in rivals.iter().enumerate().filter(|(index, _)| *index != number) {
            progress("trial run", (number * rivals.len() + index) as f64 / total);
            let refitted = best_fit(other, &fitted, settings)?;
            let refitted = evaluate(&refitted.model, &[&kept], &settings.fit)?;
            let side = side(&own, &[&kept]);
            let costs = |fit: &Fit| block_costs_of(&side, &misfit(fit));
            let (improvement, significance) = improvement_on_blocks(costs(&refitted), costs(&own));
            let (truth, other) = (truth.name.clone(), other.name.clone());
            trial_runs.push(TrialRun { truth, other, improvement, significance });
        }
    }
    Ok(trial_runs)
}
