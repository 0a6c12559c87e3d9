//! What candidates race on.

use excavator_model::recording::Recording;

use super::DiagnosisSettings;
use super::hard_stretches::hard_stretches;
use super::race::Race;
use crate::fit::{Fit, FitSettings, fit, predict};

/// Recordings that a race is run on, and the model without additions on them.
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
    pub fn whole(race: &Race<'_>) -> Self {
        let recordings: Vec<Recording> = race.identification.iter().map(|&recording| recording.clone()).collect();
        Track::of(recordings, race.base.clone(), &race.settings.fit)
    }

    /// The stretches in which the model without additions fails most; `None` where there is little to choose from, or the
    /// model cannot be fitted to them.
    pub fn hard(race: &Race<'_>) -> Option<Self> {
        let settings = race.settings;
        let duration = settings.fit.segment_duration;
        let recordings = hard_stretches(race.base, race.identification, duration, settings.race_share)?;
        // As many steps as the others get: what parameters gain that adapt to fewer readings is no gain of theirs.
        let base = fit(&race.base.model, &recordings.iter().collect::<Vec<_>>(), &short(settings)).ok()?;
        Some(Track::of(recordings, base, &settings.fit))
    }

    fn of(recordings: Vec<Recording>, base: Fit, settings: &FitSettings) -> Self {
        let borrowed: Vec<&Recording> = recordings.iter().collect();
        // A model that cannot be simulated from its measured starts is judged where its fit has brought it.
        let start_loss =
            predict(&base.model, &borrowed, settings).map_or_else(|_| base.loss(), |promise| promise.loss_before);
        Track { recordings, base, start_loss }
    }
}

/// Settings for the few steps of a race.
pub(super) fn short(settings: &DiagnosisSettings) -> FitSettings {
    FitSettings { maximum_steps: settings.race_steps, ..settings.fit }
}
