//! The log file of a process, with the folder and name that rcl uses.

use std::ffi::OsString;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use super::clock::system_nanoseconds;

/// A log file; clones share it.
#[derive(Clone)]
pub(super) struct LogFile {
    file: Arc<Mutex<File>>,
}

impl LogFile {
    /// Opens `PREFIX_PID_MILLISECONDS.log` in the log folder.
    ///
    /// # Errors
    /// A message for the user.
    pub fn open(prefix: &str) -> Result<Self, String> {
        let folder = folder(|name| std::env::var_os(name)).ok_or("no home folder")?;
        let path = folder.join(format!("{prefix}_{}_{}.log", std::process::id(), system_nanoseconds() / 1_000_000));
        std::fs::create_dir_all(&folder)
            .and_then(|()| File::create(&path))
            .map(|file| LogFile { file: Arc::new(Mutex::new(file)) })
            .map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Adds a line.
    pub fn add(&self, line: &str) {
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        // A full disk must not stop a machine; the console has the line too.
        let _ = writeln!(file, "{line}");
    }
}

/// `ROS_LOG_DIR`, else `log` in `ROS_HOME`, else `.ros/log` in the home folder.
fn folder(variable: impl Fn(&str) -> Option<OsString>) -> Option<PathBuf> {
    let path = |name: &str| variable(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    path("ROS_LOG_DIR").or_else(|| Some(path("ROS_HOME").or_else(|| Some(path("HOME")?.join(".ros")))?.join("log")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_is_that_of_rcl() {
        let of = |pairs: &[(&str, &str)]| {
            folder(|name| pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| OsString::from(value)))
        };
        assert_eq!(of(&[("ROS_LOG_DIR", "/a"), ("ROS_HOME", "/b")]), Some(PathBuf::from("/a")));
        assert_eq!(of(&[("ROS_HOME", "/b"), ("HOME", "/c")]), Some(PathBuf::from("/b/log")));
        assert_eq!(of(&[("ROS_LOG_DIR", ""), ("HOME", "/c")]), Some(PathBuf::from("/c/.ros/log")));
        assert_eq!(of(&[]), None);
    }
}
