//! Errors, each with a message of one line.

use std::path::PathBuf;

use excavator_bags::BagError;
use excavator_identification::checks::CheckError;
use excavator_identification::design::DesignError;
use excavator_identification::diagnosis::DiagnosisError;
use excavator_identification::energy::EnergyError;
use excavator_identification::fit::FitError;
use excavator_identification::identify::IdentifyError;
use excavator_identification::positioner::PositionerError;
use excavator_identification::refinement::RefineError;
use excavator_identification::regression::RegressionError;
use excavator_model::document::{DocumentError, TomlFault};
use excavator_model::formula::FormulaError;
use excavator_model::simulation::{ProfileError, RunError};
use excavator_model::{ModelError, SignalError};

use crate::mapped_units::MappedUnitError;

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum WorkError {
    #[error(transparent)]
    Recording(#[from] BagError),
    #[error(transparent)]
    Bag(#[from] rosbag2::Error),
    #[error(transparent)]
    Document(#[from] DocumentError),
    #[error("{}: {reason}", path.display())]
    Part { path: PathBuf, reason: String },
    #[error("\"{text}\": {error}")]
    Condition { text: String, error: Box<FormulaError> },
    #[error(transparent)]
    MappedUnit(#[from] MappedUnitError),
    #[error(transparent)]
    Check(#[from] CheckError),
    #[error(transparent)]
    Regression(#[from] RegressionError),
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    #[error(transparent)]
    Diagnosis(#[from] DiagnosisError),
    #[error(transparent)]
    Design(#[from] DesignError),
    #[error(transparent)]
    Energy(#[from] EnergyError),
    #[error(transparent)]
    Refine(#[from] RefineError),
    #[error(transparent)]
    Fit(#[from] FitError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Signal(#[from] SignalError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Profile(#[from] ProfileError),
    #[error("{} is not a profile: {}", path.display(), fault.message)]
    ProfileSyntax { path: PathBuf, fault: TomlFault },
    #[error("cannot write the profile: {0}")]
    ProfileWrite(String),
    #[error("profile: {machine} has no cylinder \"{cylinder}\"; it has {known}")]
    ProfileCylinder { machine: String, cylinder: String, known: String },
    #[error("{} is not what `excavator diagnose --save` or `--json` writes: {reason}", path.display())]
    DiagnosisSyntax { path: PathBuf, reason: String },
    #[error("{} has no tie: {found}", path.display())]
    NoTie { path: PathBuf, found: String },
    #[error("{} is no study: {reason}", path.display())]
    StudySyntax { path: PathBuf, reason: String },
    #[error("{} cannot be read: {source}", path.display())]
    Unreadable { path: PathBuf, source: std::io::Error },
    #[error("{} is not the recording of the study: its content has changed; run the diagnosis again", path.display())]
    Changed { path: PathBuf },
    #[error("{}: {reason}", path.display())]
    ValveTest { path: PathBuf, reason: String },
    #[error("{}: {reason}", path.display())]
    PositionTest { path: PathBuf, reason: String },
    #[error(transparent)]
    Positioner(#[from] PositionerError),
    #[error("{} is not a data sheet: {reason}", path.display())]
    SheetSyntax { path: PathBuf, reason: String },
    #[error("no recording to compare the model with")]
    NoRecording,
    #[error("cannot write JSON: {0}")]
    Json(#[from] serde_json::Error),
}

impl WorkError {
    /// The faulty line of a file with a mark at the position; empty if there is none.
    pub fn excerpt(&self) -> &str {
        match self {
            WorkError::Document(error) => error.excerpt(),
            WorkError::Recording(BagError::Map(error)) => error.excerpt(),
            WorkError::ProfileSyntax { fault, .. } => &fault.excerpt,
            _ => "",
        }
    }
}
