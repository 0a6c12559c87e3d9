//! Why a verb failed, in one line.

use std::path::{Path, PathBuf};

use excavator_bags::BagError;
use excavator_identification::checks::CheckError;
use excavator_identification::design::DesignError;
use excavator_identification::diagnosis::DiagnosisError;
use excavator_identification::energy::EnergyError;
use excavator_identification::fit::FitError;
use excavator_identification::identify::IdentifyError;
use excavator_identification::refinement::RefineError;
use excavator_identification::regression::RegressionError;
use excavator_model::ModelError;
use excavator_model::document::DocumentError;
use excavator_model::effects::UnknownEffect;
use excavator_model::formula::FormulaError;
use excavator_model::simulation::RunError;
use excavator_study::WorkError;

#[cfg(feature = "live")]
use excavator_nodes::NodeError;
#[cfg(feature = "live")]
use excavator_ros::RosError;

/// Why a verb failed.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum VerbError {
    #[error(transparent)]
    Recording(#[from] BagError),
    #[error(transparent)]
    Bag(#[from] rosbag2::Error),
    #[error(transparent)]
    Work(Box<WorkError>),
    #[error(transparent)]
    Document(#[from] DocumentError),
    #[error("--where \"{text}\": {error}")]
    Condition { text: String, error: Box<FormulaError> },
    #[error("{}", refusal(.0))]
    Check(#[from] CheckError),
    #[error(transparent)]
    Regression(#[from] RegressionError),
    #[error(transparent)]
    Fit(#[from] FitError),
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
    Run(#[from] RunError),
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
    #[cfg(feature = "live")]
    #[error("{}", failure_of_node(.0))]
    Node(#[from] NodeError),
    #[error("cannot write {}: {source}", path.display())]
    Write { path: PathBuf, source: std::io::Error },
    #[error("{wrong} {} a problem; see the list above", if *wrong == 1 { "law has" } else { "laws have" })]
    Laws { wrong: usize },
    #[error("{name} has {oddities} implausible {}; see the list above", if *oddities == 1 { "value" } else { "values" })]
    OddModel { name: String, oddities: usize },
    #[error("valve test: {0}")]
    ValveTest(String),
    #[error("no model: {0}")]
    NewModel(String),
    #[error("--catalogue {}: {reason}", path.display())]
    Catalogue { path: PathBuf, reason: String },
    #[error("cannot write JSON: {0}")]
    Json(#[from] serde_json::Error),
    #[error("{0}")]
    Terminal(#[from] std::io::Error),
    #[cfg(feature = "live")]
    #[error("the {part} ended by itself: {status}")]
    PartEnded { part: &'static str, status: String },
    #[cfg(feature = "live")]
    #[error("{0}")]
    Motion(String),
    #[cfg(feature = "live")]
    #[error("the {part} did not end in good order: {status}; it has said why above")]
    PartFailed { part: &'static str, status: String },
    #[error(
        "no profile is written, because no manoeuvre within the limits is expected to suffice: {0}; try a longer --duration or a smaller --stroke-margin"
    )]
    NothingSeparates(String),
    #[error("{}: {reason}; a part is BAG@FROM..TO, in seconds after the first sample", path.display())]
    Part { path: PathBuf, reason: String },
    #[error("{option} {} would be lost: {what}; give another name", path.display())]
    SameFile { option: &'static str, path: PathBuf, what: String },
    #[error("{} exists already and is not overwritten; give another name, or --force to replace it", path.display())]
    Exists { path: PathBuf },
    #[error("{} is a symbolic link and is not written through; give the name of the file itself", path.display())]
    Link { path: PathBuf },
    #[error("{} appeared while this command ran and is not overwritten; the result is in {}", path.display(), kept.display())]
    Appeared { path: PathBuf, kept: PathBuf },
    #[error("cannot print the result: {0}")]
    NotPrinted(String),
    #[error("a map is guessed from one file, not from {0}; the others of the same recording take the same map")]
    GuessOfSeveral(usize),
}

impl VerbError {
    /// Returns a closure for `map_err` after an attempt to write `path`.
    pub fn write(path: &Path) -> impl FnOnce(std::io::Error) -> VerbError {
        move |source| VerbError::Write { path: path.to_path_buf(), source }
    }

    /// The faulty line of a file with a mark at the position; empty if there is none.
    pub fn excerpt(&self) -> &str {
        match self {
            VerbError::Document(error) => error.excerpt(),
            VerbError::Recording(BagError::Map(error)) => error.excerpt(),
            VerbError::Work(error) => error.excerpt(),
            #[cfg(feature = "live")]
            VerbError::Node(error) => error.excerpt(),
            _ => "",
        }
    }

    /// 2 for wrong usage, 1 for every other failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            #[cfg(feature = "live")]
            VerbError::Node(error) if error.is_wrong_usage() => 2,
            VerbError::Design(DesignError::Alone { .. }) => 2,
            _ => 1,
        }
    }
}

impl From<WorkError> for VerbError {
    /// Errors whose message names an option of the program, or that verbs distinguish, get variants of their own.
    fn from(error: WorkError) -> Self {
        match error {
            WorkError::Recording(error) => error.into(),
            WorkError::Bag(error) => error.into(),
            WorkError::Condition { text, error } => VerbError::Condition { text, error },
            WorkError::Check(error) => error.into(),
            WorkError::Part { path, reason } => VerbError::Part { path, reason },
            WorkError::Regression(error) => error.into(),
            WorkError::Model(error) => error.into(),
            WorkError::Design(error) => error.into(),
            WorkError::Document(error) => error.into(),
            WorkError::Identify(error) => error.into(),
            WorkError::Diagnosis(error) => error.into(),
            WorkError::Energy(error) => error.into(),
            WorkError::Refine(error) => error.into(),
            WorkError::Run(error) => error.into(),
            error => VerbError::Work(Box::new(error)),
        }
    }
}

/// The message of a failed check, with the option that overrides it.
fn refusal(error: &CheckError) -> String {
    let how = error.name().map(|name| format!("; if this is right, say --accept {name}"));
    format!("{error}{}", how.unwrap_or_default())
}

/// The message of a node's failure, with the options that change what failed.
#[cfg(feature = "live")]
fn failure_of_node(error: &NodeError) -> String {
    match error {
        #[cfg(feature = "dashboard")]
        NodeError::Listen { .. } => format!("{error}; choose another --port or --host"),
        _ => error.to_string(),
    }
}

#[cfg(feature = "live")]
impl From<RosError> for VerbError {
    fn from(error: RosError) -> Self {
        VerbError::Node(error.into())
    }
}
