//! Why there is no result, in one line.

use std::path::PathBuf;

use excavator_bags::BagError;
use excavator_identification::design::DesignError;
use excavator_identification::diagnosis::DiagnosisError;
use excavator_identification::energy::EnergyError;
use excavator_identification::fit::FitError;
use excavator_identification::gate::GateError;
use excavator_identification::refinement::RefineError;
use excavator_identification::regression::RegressionError;
use excavator_model::document::DocumentError;
use excavator_model::formula::FormulaError;
use excavator_model::simulation::{ProfileError, RunError, SimulationError};
use excavator_model::{ModelError, SignalError};

/// Why there is no result.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum WorkError {
    #[error(transparent)]
    Bag(#[from] BagError),
    #[error(transparent)]
    Document(#[from] DocumentError),
    #[error("\"{text}\": {error}")]
    Condition { text: String, error: Box<FormulaError> },
    #[error(transparent)]
    Gate(#[from] GateError),
    #[error(transparent)]
    Regression(#[from] RegressionError),
    #[error(transparent)]
    Fit(#[from] FitError),
    #[error(transparent)]
    Diagnosis(#[from] DiagnosisError),
    #[error(transparent)]
    Design(#[from] DesignError),
    #[error(transparent)]
    Energy(#[from] EnergyError),
    #[error(transparent)]
    Refine(#[from] RefineError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(transparent)]
    Signal(#[from] SignalError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Profile(#[from] ProfileError),
    #[error("{} is not a profile: {reason}", path.display())]
    ProfileSyntax { path: PathBuf, reason: String },
    #[error("cannot write the profile: {0}")]
    ProfileWrite(String),
    #[error("profile: {machine} has no cylinder \"{cylinder}\"; it has {known}")]
    ProfileCylinder { machine: String, cylinder: String, known: String },
    #[error("{} is not what `excavator diagnose --json` writes: {reason}", path.display())]
    DiagnosisSyntax { path: PathBuf, reason: String },
    #[error("{} has no tie: {found}; name rivals with --between", path.display())]
    NoTie { path: PathBuf, found: String },
    #[error("cannot add {0} twice")]
    AddedTwice(String),
}
