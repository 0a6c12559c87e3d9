//! Why a node ended with a failure, in one line.

use std::path::PathBuf;

use excavator_model::document::DocumentError;
use excavator_ros::RosError;
use excavator_study::WorkError;

/// Why a node could not start, or did not end in good order.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)]
pub enum NodeError {
    #[error(transparent)]
    Ros(#[from] RosError),
    #[error(transparent)]
    Model(#[from] WorkError),
    #[error(transparent)]
    Bag(#[from] rosbag2::Error),
    #[error("{0}")]
    System(#[from] std::io::Error),
    #[error("{0}")]
    Machine(String),
    #[cfg(feature = "dashboard")]
    #[error("cannot offer a page at {address}: {source}")]
    Listen { address: String, source: std::io::Error },
    #[error("files of the recording were deleted or moved while it was written: {files}; the rest is in {}", bag.display())]
    RecordingGone { bag: PathBuf, files: String },
}

impl From<DocumentError> for NodeError {
    fn from(error: DocumentError) -> Self {
        NodeError::Model(error.into())
    }
}

impl NodeError {
    /// The faulty line of a model file with a mark at the position; empty if there is none.
    pub fn excerpt(&self) -> &str {
        match self {
            NodeError::Model(error) => error.excerpt(),
            _ => "",
        }
    }

    /// Whether the arguments of the node are wrong, and not what it met.
    pub fn is_wrong_usage(&self) -> bool {
        matches!(self, NodeError::Ros(RosError::Arguments(_)))
    }
}
