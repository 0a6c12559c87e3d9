//! Programs of this package on networks of their own.
//!
//! A network namespace with a loopback that has multicast keeps tests apart from each other and from the machine. Where
//! namespaces cannot be made (no root), the tests that need them skip with a line that says so.
#![allow(dead_code)]

mod bags;
mod network;
mod program;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

pub use bags::{custom_number, messages, messages_so_far, openings, recorded, records};
pub use network::Network;
pub use program::{Program, kill};

pub use crate::common::LONGEST_WAIT;

/// Waits until something holds.
pub fn until(what: &str, mut holds: impl FnMut() -> bool) {
    found(what, || holds().then_some(()));
}

/// Waits until `of` finds something; returns it.
pub fn found<T>(what: &str, mut of: impl FnMut() -> Option<T>) -> T {
    let end = Instant::now() + LONGEST_WAIT;
    loop {
        if let Some(found) = of() {
            return found;
        }
        assert!(Instant::now() < end, "waited {} s in vain for {what}", LONGEST_WAIT.as_secs());
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Lets time pass that is the subject of a test: an outage, a rhythm. Never in place of a condition.
pub fn sleep(seconds: f64) {
    std::thread::sleep(Duration::from_secs_f64(seconds));
}

/// An interpreter with another DDS, Eclipse Cyclone; `None`, with a line that says so, where there is none.
pub fn python_with_cyclone() -> Option<PathBuf> {
    let python = match std::env::var_os("EXCAVATOR_PYTHON") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../.venv/bin/python"),
    };
    let found = Command::new(&python).args(["-c", "import cyclonedds"]).output().is_ok_and(|run| run.status.success());
    if !found {
        println!("skipped: {} has no cyclonedds (set EXCAVATOR_PYTHON to an interpreter that has)", python.display());
    }
    found.then_some(python)
}

pub fn folder() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_path_buf();
    (folder, path)
}
