//! Files of a bag that are deleted or moved during recording.

use std::path::PathBuf;

use super::part::{Location, Written};

/// A file of a bag that is no longer at its path. A moved file is complete at its new path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GoneFile {
    /// Its original path.
    pub path: PathBuf,
    /// Number of messages per topic, in the order in which the topics were added.
    pub by_topic: Vec<u64>,
    /// Its size, bytes.
    pub bytes: u64,
}

impl GoneFile {
    pub(super) fn new(location: &Location, written: Written) -> Self {
        GoneFile { path: location.path().to_path_buf(), by_topic: written.by_topic, bytes: written.bytes }
    }

    /// Number of messages in it.
    pub fn messages(&self) -> u64 {
        self.by_topic.iter().sum()
    }
}

impl std::fmt::Display for GoneFile {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} ({} messages, {} bytes)", self.path.display(), self.messages(), self.bytes)
    }
}
