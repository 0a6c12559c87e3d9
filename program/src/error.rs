//! Why a verb failed, in one line.

use std::path::{Path, PathBuf};

use excavator_bags::BagError;
use excavator_identification::design::DesignError;
use excavator_identification::refinement::RefineError;
use excavator_model::ModelError;
use excavator_model::document::DocumentError;
use excavator_model::effects::UnknownEffect;
use excavator_model::simulation::RunError;
#[cfg(feature = "live")]
use excavator_nodes::NodeError;
#[cfg(feature = "live")]
use excavator_ros::RosError;
use excavator_study::WorkError;

/// Why a verb failed: a study or a node did, or the program itself.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum VerbError {
    #[error("{}", failure_of_study(.0))]
    Study(#[from] WorkError),
    #[cfg(feature = "live")]
    #[error("{}", failure_of_node(.0))]
    Node(#[from] NodeError),
    #[error(transparent)]
    UnknownEffect(#[from] UnknownEffect),
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
    #[error("--signal {name}: no recording measures it; they measure {measured}")]
    NoSignal { name: String, measured: String },
    #[error("data sheet: {0}")]
    Sheet(String),
    #[error("--catalogue {}: {reason}", path.display())]
    Catalogue { path: PathBuf, reason: String },
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
            VerbError::Study(error) => error.excerpt(),
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
            VerbError::Study(WorkError::Design(DesignError::Alone { .. })) => 2,
            _ => 1,
        }
    }
}

/// The message of a study's failure, with the option of the program that it concerns.
fn failure_of_study(error: &WorkError) -> String {
    match error {
        WorkError::Condition { .. } => format!("--where {error}"),
        WorkError::Part { .. } => format!("{error}; a part is BAG@FROM..TO, in seconds after the first sample"),
        WorkError::Check(check) => match check.name() {
            Some(name) => format!("{error}; if this is right, say --accept {name}"),
            None => error.to_string(),
        },
        WorkError::NoTie { .. } => format!("{error}; name rivals with --between"),
        _ => error.to_string(),
    }
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

/// What a verb asks of a crate below the studies fails as a study does.
macro_rules! fails_as_a_study {
    ($($error:ty),+) => {
        $(impl From<$error> for VerbError {
            fn from(error: $error) -> Self {
                VerbError::Study(error.into())
            }
        })+
    };
}

fails_as_a_study!(BagError, rosbag2::Error, DocumentError, ModelError, RefineError, RunError, serde_json::Error);
