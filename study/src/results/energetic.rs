//! Energy analysis of a recording.

use excavator_identification::energy::{Analyser, EnergyAnalysis, EnergySettings, analyse, missing_power};
use excavator_identification::results;
use excavator_model::Model;
use excavator_report::energy_page;

use super::Outcome;
use crate::recordings::{LEDGER_BLOCK, blocks};
use crate::sentences::ledger_sentence;
use crate::{Study, WorkError, json_text};

/// Result of `energy`.
pub struct Energetic {
    model: Model,
    analysis: EnergyAnalysis,
}

impl Study {
    /// Analyses the energy of the first validation recording as a whole.
    ///
    /// # Errors
    /// [`WorkError::Energy`], [`WorkError::NoRecording`].
    pub fn energy(&self) -> Result<Energetic, WorkError> {
        let recording = self.validation.first().ok_or(WorkError::NoRecording)?;
        let analysis = analyse(&self.model, recording, EnergySettings::default())?;
        Ok(Energetic { model: self.model.clone(), analysis })
    }

    /// The same block by block, as the program reads a bag with its own topics.
    ///
    /// # Errors
    /// As [`Study::energy`].
    pub fn energy_in_blocks(&self) -> Result<Energetic, WorkError> {
        let recording = self.validation.first().ok_or(WorkError::NoRecording)?;
        let mut analyser = Analyser::new(&self.model, EnergySettings::default());
        blocks(recording, LEDGER_BLOCK).try_for_each(|block| analyser.push(&block))?;
        Ok(Energetic { model: self.model.clone(), analysis: analyser.finish()? })
    }
}

impl Outcome for Energetic {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&results::Energy::of(&self.model, &self.analysis))
    }

    fn sentence(&self) -> String {
        ledger_sentence(&self.model, &self.analysis, &missing_power(&self.model, &self.analysis))
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(energy_page(&self.model, &self.analysis)))
    }
}
