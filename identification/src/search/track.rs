//! The recordings that candidates are screened on.

use excavator_model::recording::Recording;

use super::Effort;
use super::hard_stretches::hard_stretches;
use super::screening::Screening;
use crate::fit::{Fit, FitSettings, fit, predict};

/// Recordings, or parts of them, and the model without additions on them.
pub(super) struct Track {
    /// The recordings, or parts of them.
    pub recordings: Vec<Recording>,
    /// The model without additions, fitted to them.
    pub base: Fit,
    /// Loss of that where its segments start as measured.
    pub start_loss: f64,
}

impl Track {
    /// All that is fitted.
    pub fn whole(screening: &Screening<'_>) -> Self {
        let recordings: Vec<Recording> = screening.identification.iter().map(|&one| one.clone()).collect();
        Track::of(recordings, screening.base.fit.clone(), &screening.effort.fit)
    }

    /// The stretches in which the model without additions fails most; `None` where there is little to choose from, or the
    /// model cannot be fitted to them.
    pub fn hard(screening: &Screening<'_>) -> Option<Self> {
        let effort = screening.effort;
        let (base, duration) =
            (&screening.base.fit, effort.fit.segment_duration_for(&screening.base.fit.model.machine.size()));
        let recordings = hard_stretches(base, screening.identification, duration, effort.screening_share)?;
        // As many steps as the candidates get: an improvement that comes from fewer readings is none of theirs.
        let base = fit(&base.model, &recordings.iter().collect::<Vec<_>>(), &few_steps(effort)).ok()?;
        Some(Track::of(recordings, base, &effort.fit))
    }

    fn of(recordings: Vec<Recording>, base: Fit, settings: &FitSettings) -> Self {
        let borrowed: Vec<&Recording> = recordings.iter().collect();
        // A model that cannot be simulated from its measured starts is judged where its fit has brought it.
        let start_loss =
            predict(&base.model, &borrowed, settings).map_or_else(|_| base.loss(), |promise| promise.loss_before);
        Track { recordings, base, start_loss }
    }
}

/// Settings for the few steps of a screening.
pub(super) fn few_steps(effort: &Effort) -> FitSettings {
    FitSettings { maximum_steps: effort.screening_steps, ..effort.fit }
}
