//! Running the program as a user would.
#![allow(dead_code, missing_docs)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Duration;

/// Longest that a test waits for anything. What is waited for comes within seconds; a busy machine gets the rest.
pub const LONGEST_WAIT: Duration = Duration::from_secs(90);

/// Runs `excavator` with these words in `folder`.
pub fn excavator(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_excavator")).args(words).current_dir(folder).output().expect("program starts")
}

/// Standard error as text.
pub fn complaint(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Standard output as JSON.
pub fn json(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{}", complaint(output));
    serde_json::from_slice(&output.stdout).expect("JSON on standard output")
}

/// The folder of measured and practice recordings, or `None` with a line that says so.
pub fn shared() -> Option<PathBuf> {
    let folder = std::env::var_os("EXCAVATOR_SHARED")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared"), PathBuf::from);
    if folder.join("practice").is_dir() {
        return Some(folder);
    }
    eprintln!("skipped: no practice recordings at {}", folder.display());
    None
}

/// One clear line on standard error, exit status 1, no panic.
pub fn assert_one_clear_line(output: &Output, must_contain: &[&str]) {
    let complaint = complaint(output);
    assert_eq!(output.status.code(), Some(1), "{complaint}");
    assert_eq!(complaint.trim_end().lines().filter(|line| line.starts_with("excavator: ")).count(), 1, "{complaint}");
    assert!(!complaint.contains("panicked"), "{complaint}");
    for part in must_contain {
        assert!(complaint.contains(part), "\"{part}\" is missing in: {complaint}");
    }
}
