//! Files of a bag that somebody deletes or moves while it is written.

use std::path::PathBuf;

use super::part::{Location, Written};

/// A file of a bag that was not at its place any more. One that was moved is complete where it is now.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GoneFile {
    /// Where it was.
    pub path: PathBuf,
    /// Messages in it, of each topic in the order in which they were added.
    pub by_topic: Vec<u64>,
    /// Its size.
    pub bytes: u64,
}

impl GoneFile {
    pub(super) fn new(location: &Location, written: Written) -> Self {
        GoneFile { path: location.path().to_path_buf(), by_topic: written.by_topic, bytes: written.bytes }
    }

    /// Messages in it.
    pub fn messages(&self) -> u64 {
        self.by_topic.iter().sum()
    }
}

impl std::fmt::Display for GoneFile {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{} ({} messages, {} bytes)", self.path.display(), self.messages(), self.bytes)
    }
}
