//! The ledgers of several recordings.

use excavator_model::Model;
use excavator_model::recording::Recording;

use super::{EnergySettings, MissingPower, analyse, missing_power};

/// The ledger of `model` for each recording with measured energy, together with the recording's source. A recording without
/// pressures has no ledger and is skipped.
pub fn ledgers(model: &Model, recordings: &[&Recording]) -> Vec<(String, Vec<MissingPower>)> {
    let analyses = recordings.iter().map(|recording| analyse(model, recording, EnergySettings::default()));
    analyses.flatten().map(|analysis| (analysis.source.clone(), missing_power(model, &analysis))).collect()
}
