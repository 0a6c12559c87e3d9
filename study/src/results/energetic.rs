//! Energy analysis of a recording.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::mpsc::Receiver;

use excavator_identification::energy::{
    Analyser, EnergyAnalysis, EnergyError, EnergySettings, MissingPower, analyse, missing_power,
};
use excavator_identification::results;
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::energy_page;

use super::Outcome;
use crate::block_reader::{needs_a_map, read_beside};
use crate::preparation::Preparation;
use crate::recordings::{LEDGER_BLOCK, blocks};
use crate::sentences::ledger_sentence;
use crate::{Study, WorkError, json_text};

/// Most blocks queued for the analysis.
const WAITING: usize = 4;

/// Result of `energy`.
pub struct Energetic {
    /// The model.
    pub model: Model,
    /// Where the energy went.
    pub analysis: EnergyAnalysis,
}

impl Study {
    /// Analyses the energy of the first validation recording as a whole.
    ///
    /// # Errors
    /// [`WorkError::Energy`], [`WorkError::NoRecording`].
    pub fn energy(self) -> Result<Energetic, WorkError> {
        let recording = self.validation.first().ok_or(WorkError::NoRecording)?;
        let analysis = analyse(&self.model, recording, EnergySettings::default())?;
        Ok(Energetic { model: self.model, analysis })
    }

    /// The same block by block, as [`Preparation::energy`] reads a bag with its own topics.
    ///
    /// # Errors
    /// As [`Study::energy`].
    pub fn energy_in_blocks(self) -> Result<Energetic, WorkError> {
        let recording = self.validation.first().ok_or(WorkError::NoRecording)?;
        let analysis = analysed(&self.model, blocks(recording, LEDGER_BLOCK))?.finish()?;
        Ok(Energetic { model: self.model, analysis })
    }
}

impl Preparation<'_> {
    /// Analyses the energy of a recording. A bag of our own topics is read in blocks, whatever its length. A recording that needs a map
    /// is read whole.
    ///
    /// # Errors
    /// [`WorkError::Energy`], and as [`Preparation::whole`].
    pub fn energy(&self, bag: &Path, model: Model) -> Result<Energetic, WorkError> {
        if needs_a_map(bag, self.origin.map) {
            let recording = self.whole(bag, &model)?;
            return Study::of_recording(model, recording).energy();
        }
        let work = |blocks: Receiver<Recording>| analysed(&model, blocks);
        let all = |block| (Some(block), ControlFlow::Continue(()));
        let (report, analyser) = read_beside(bag, self.origin.namespace, LEDGER_BLOCK, WAITING, all, work)?;
        report.problems().iter().for_each(|problem| (self.remark)(&format!("{}: {problem}", bag.display())));
        let analysis = analyser?.finish()?;
        Ok(Energetic { model, analysis })
    }
}

fn analysed(model: &Model, blocks: impl IntoIterator<Item = Recording>) -> Result<Analyser<'_>, EnergyError> {
    let mut analyser = Analyser::new(model, EnergySettings::default());
    blocks.into_iter().try_for_each(|block| analyser.push(&block))?;
    Ok(analyser)
}

impl Energetic {
    /// Power that is missing, most significant first; empty if the ledger closes.
    #[must_use]
    pub fn missing(&self) -> Vec<MissingPower> {
        missing_power(&self.model, &self.analysis)
    }
}

impl Outcome for Energetic {
    fn json(&self) -> Result<String, WorkError> {
        json_text(&results::Energy::of(&self.model, &self.analysis))
    }

    fn sentence(&self) -> String {
        ledger_sentence(&self.model, &self.analysis, &self.missing())
    }

    fn page(&self) -> Result<Option<String>, WorkError> {
        Ok(Some(energy_page(&self.model, &self.analysis)))
    }
}
