//! Errors that prevent a node from starting or running on.

use std::path::PathBuf;

/// Why a node cannot start or run on.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
#[non_exhaustive]
pub enum RosError {
    #[error("--ros-args: {0}")]
    Arguments(String),
    #[error("{0}")]
    Parameter(String),
    #[error("{variable}={value} is {problem}")]
    Environment { variable: &'static str, value: String, problem: String },
    #[error("ROS_SECURITY_STRATEGY={strategy}, not starting: {problem}")]
    Security { strategy: &'static str, problem: String },
    #[error("cannot read parameters from {}: {reason}", path.display())]
    ParameterFile { path: PathBuf, reason: String },
    #[error("\"{name}\" is not a name in ROS: {reason}")]
    Name { name: String, reason: String },
    #[error("cannot join ROS domain {domain}: {reason}")]
    Join { domain: u16, reason: String },
    #[error("cannot open {what}: {reason}")]
    Endpoint { what: String, reason: String },
    #[error("cannot {action}: {source}")]
    System { action: &'static str, source: std::io::Error },
}
