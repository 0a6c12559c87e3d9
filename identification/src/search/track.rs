//! The recordings that candidates are screened on.

use std::sync::OnceLock;

use excavator_model::recording::Recording;

use super::addition::{Addition, AdditionError, PromisingStart, best_start, most_promising};
use super::hard_stretches::hard_stretches;
use super::promises::{Promised, promises};
use super::starts::ground;
use super::{Effort, Trial};
use crate::fit::{Fit, FitSettings, fit, predict};
use crate::regression::Ground;

/// Recordings, or parts of them, and the base model on them to which effects are added.
pub(super) struct Track<'a> {
    whole: &'a [&'a Recording],
    /// Used instead of the whole recordings.
    parts: Option<Vec<Recording>>,
    /// The model without additions, fitted to them.
    pub base: Fit,
    start_loss: OnceLock<f64>,
    ground: OnceLock<Option<Ground>>,
}

impl<'a> Track<'a> {
    /// Uses all fitted recordings.
    pub fn whole(base: &Trial, recordings: &'a [&'a Recording]) -> Self {
        Track::new(recordings, None, base.fit.clone())
    }

    fn new(whole: &'a [&'a Recording], parts: Option<Vec<Recording>>, base: Fit) -> Self {
        Track { whole, parts, base, start_loss: OnceLock::new(), ground: OnceLock::new() }
    }

    /// Uses the stretches in which the model without additions fails most. Returns `None` if there is little to choose
    /// from, or the model cannot be fitted to them.
    pub fn hard(base: &Trial, recordings: &'a [&'a Recording], effort: &Effort) -> Option<Self> {
        let duration = effort.fit.segment_duration_for(&base.fit.model.machine.size());
        let parts = hard_stretches(&base.fit, recordings, duration, effort.screening_share)?;
        // The base gets as many steps as the candidates, so that an improvement from fewer readings is not credited to
        // them.
        let base = fit(&base.fit.model, &parts.iter().collect::<Vec<_>>(), &few_steps(effort)).ok()?;
        Some(Track::new(recordings, Some(parts), base))
    }

    /// The recordings, or parts of them.
    pub fn recordings(&self) -> Vec<&Recording> {
        match &self.parts {
            Some(parts) => parts.iter().collect(),
            None => self.whole.to_vec(),
        }
    }

    /// Loss of the model without additions with measured initial states.
    pub fn start_loss(&self, settings: &FitSettings) -> f64 {
        // If the model cannot be simulated from its measured initial states, the loss of its fit is used.
        let simulated = || predict(&self.base.model, &self.recordings(), settings);
        *self.start_loss.get_or_init(|| simulated().map_or_else(|_| self.base.loss(), |promise| promise.loss_before))
    }

    /// Predictions for each addition from one simulation of the model without additions.
    pub fn promised(&self, wanted: &[Addition], settings: &FitSettings) -> Vec<Option<Promised>> {
        promises(&self.base.model, wanted, &self.recordings(), settings)
            .unwrap_or_else(|| wanted.iter().map(|_| None).collect())
    }

    /// The most promising start of an addition: one of the `promised` starts if its simulation confirms the prediction,
    /// otherwise the best of all. All starts are tried too if the predicted improvement is less than `least`.
    ///
    /// # Errors
    /// [`AdditionError`].
    pub fn start(
        &self,
        addition: &Addition,
        promised: Option<Promised>,
        least: f64,
        effort: &Effort,
    ) -> Result<PromisingStart, AdditionError> {
        let (recordings, settings) = (self.recordings(), &effort.fit);
        let all = || best_start(&self.base.model, addition, &recordings, self.ground(), settings);
        let Some(Promised { improvement, starts, .. }) = promised.filter(|own| own.improvement >= least) else {
            return all();
        };
        let first = starts.into_iter().take(effort.promised_starts).map(|start| start.model).collect();
        let Ok(start) = most_promising(first, &recordings, settings) else { return all() };
        if self.base.loss() - start.promise.loss_after >= effort.least_reached_share * improvement {
            return Ok(start);
        }
        Ok(all().ok().filter(|other| other.promise.loss_after < start.promise.loss_after).unwrap_or(start))
    }

    fn ground(&self) -> Option<&Ground> {
        self.ground.get_or_init(|| ground(&self.base.model, &self.recordings())).as_ref()
    }
}

/// Settings for the few steps of a screening.
pub(super) fn few_steps(effort: &Effort) -> FitSettings {
    FitSettings { maximum_steps: effort.screening_steps, ..effort.fit }
}
