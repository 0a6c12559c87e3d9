//! Where the energy of a recording went.

use excavator_identification::energy::{Analyser, EnergyAnalysis, EnergySettings, analyse, missing_power};
use excavator_identification::report::energy_page;
use excavator_model::Model;
use excavator_model::recording::Recording;
use serde_json::Value;

use super::Outcome;
use crate::WorkError;
use crate::json::energy_json;

/// Samples per block: ten seconds at 1 kHz.
const BLOCK: usize = 10_000;

/// Result of `energy`.
pub struct Energetic {
    model: Model,
    analysis: EnergyAnalysis,
}

impl Energetic {
    /// Analyses a recording as a whole.
    ///
    /// # Errors
    /// [`WorkError::Energy`].
    pub fn of(model: &Model, recording: &Recording) -> Result<Self, WorkError> {
        let analysis = analyse(model, recording, EnergySettings::default())?;
        Ok(Energetic { model: model.clone(), analysis })
    }

    /// The same block by block, as the program reads a bag of its own topics.
    ///
    /// # Errors
    /// [`WorkError::Energy`].
    pub fn of_blocks(model: &Model, recording: &Recording) -> Result<Self, WorkError> {
        let mut analyser = Analyser::new(model, EnergySettings::default());
        for first in (0..recording.len()).step_by(BLOCK) {
            let samples: Vec<usize> = (first..recording.len().min(first + BLOCK)).collect();
            let mut block = recording.at(&samples);
            let start = block.time.first().copied().unwrap_or(0.0);
            block.time.iter_mut().for_each(|time| *time -= start);
            block.start_nanoseconds += (start * 1e9).round() as i64;
            analyser.push(&block)?;
        }
        Ok(Energetic { model: model.clone(), analysis: analyser.finish()? })
    }
}

impl Outcome for Energetic {
    fn json(&self) -> Value {
        energy_json(&self.model, &self.analysis)
    }

    fn sentence(&self) -> String {
        let over = format!("{:.1} s of {}", self.analysis.duration, self.analysis.source);
        match missing_power(&self.model, &self.analysis).first() {
            None => format!(
                "The ledger of {} closes over {over}: noise explains the rest of every equation.",
                self.model.machine.name
            ),
            Some(first) => {
                format!("The ledger of {} does not close over {over}. {}", self.model.machine.name, first.sentence)
            }
        }
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(energy_page(&self.model, &self.analysis)))
    }
}
