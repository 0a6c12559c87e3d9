//! Why a verb failed, in one line.

use std::path::PathBuf;

use excavator_bags::BagError;
use excavator_identification::diagnosis::DiagnosisError;
use excavator_identification::fit::FitError;
use excavator_identification::gate::GateError;
use excavator_identification::refinement::RefineError;
use excavator_identification::regression::RegressionError;
use excavator_model::document::DocumentError;
use excavator_model::effects::UnknownEffect;
use excavator_model::simulation::{ProfileError, RunError};
use excavator_model::{ModelError, SignalError};

/// Why a verb failed.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum VerbError {
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error(transparent)]
    Document(#[from] DocumentError),
    #[error(transparent)]
    Gate(#[from] GateError),
    #[error(transparent)]
    Regression(#[from] RegressionError),
    #[error(transparent)]
    Fit(#[from] FitError),
    #[error(transparent)]
    Diagnosis(#[from] DiagnosisError),
    #[error(transparent)]
    Refine(#[from] RefineError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Signal(#[from] SignalError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    #[error(transparent)]
    Profile(#[from] ProfileError),
    #[error("cannot read {}: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("{} is not a profile: {reason}", path.display())]
    ProfileSyntax { path: PathBuf, reason: String },
    #[error("profile: {machine} has no cylinder \"{cylinder}\"; it has {known}")]
    ProfileCylinder { machine: String, cylinder: String, known: String },
    #[error("cannot write JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error("{0}")]
    Terminal(#[from] std::io::Error),
    #[error("cannot add {0} twice")]
    AddedTwice(String),
}
