//! Cases as bags, for people who want to look at one.

use std::path::Path;

use excavator_bags::{BagError, Topics, write_recording};
use rosbag2::WriteOptions;
use serde_json::json;

use crate::cases::Case;
use crate::scoring::Evidence;

/// Why a case could not be stored.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// A bag.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The answer.
    #[error("cannot write {path}: {source}")]
    Answer {
        /// Where to.
        path: String,
        /// Why not.
        source: std::io::Error,
    },
}

/// Writes `FOLDER/caseN/{identification,validation}` and `FOLDER/caseN/answer.json`.
///
/// # Errors
/// [`StoreError`], first of all when the bags are there already.
pub fn store(folder: &Path, case: &Case, evidence: &Evidence) -> Result<(), StoreError> {
    let place = folder.join(format!("case{}", case.number));
    let (topics, options) = (Topics::default(), WriteOptions::default());
    write_recording(&place.join("identification"), &evidence.identification, &topics, &options)?;
    write_recording(&place.join("validation"), &evidence.validation, &topics, &options)?;
    let named = |values: &[(&str, f64)]| -> serde_json::Map<String, serde_json::Value> {
        values.iter().map(|(name, value)| (name.to_string(), json!(value))).collect()
    };
    let [identification, validation] = evidence.change.map(|change| change.nmse);
    let answer = json!({
        "effects": case.hidden.iter().map(|kind| kind.name).collect::<Vec<_>>(),
        "strength": case.strength.name(),
        "truth": named(&case.plant.base.named()),
        "added": named(&case.truth()),
        "nmse_without_effect_identification": identification,
        "nmse_without_effect_validation": validation,
        "nmse_signals": ["displacement", "velocity", "cap_pressure", "rod_pressure", "pump_pressure"],
    });
    let path = place.join("answer.json");
    std::fs::write(&path, format!("{answer:#}\n"))
        .map_err(|source| StoreError::Answer { path: path.display().to_string(), source })
}
