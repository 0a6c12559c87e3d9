//! The ledgers of several recordings.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::{EnergySettings, MissingPower, analyse, missing_power};

/// What the energy ledger of `model` says of each recording in which energy is known, with the recording's source. A recording without the
/// pressures has no ledger and is left out.
pub fn ledgers(model: &Model, recordings: &[&Recording]) -> Vec<(String, Vec<MissingPower>)> {
    let analyses = recordings.iter().map(|recording| analyse(model, recording, EnergySettings::default()));
    analyses.flatten().map(|analysis| (analysis.source.clone(), missing_power(model, &analysis))).collect()
}
