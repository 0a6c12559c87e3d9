//! Good bytes to begin with: the samples and configurations of this repository.

use std::path::{Path, PathBuf};

/// A file of the repository.
pub fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name)
}

/// Content of a file of the repository; empty where it is not, which no target takes for good.
pub fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).unwrap_or_default()
}

/// The first bytes of a file of the repository, to the end of a line.
pub fn lines(name: &str, length: usize) -> Vec<u8> {
    let mut bytes = bytes(name);
    let end = bytes.iter().take(length).rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
    bytes.truncate(end);
    bytes
}
