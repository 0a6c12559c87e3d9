//! Programs of others in Python, each run in a process of its own.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde::Deserialize;

use crate::figures::Run;

/// The Python that has the programs of others.
pub struct Peers {
    python: Option<PathBuf>,
}

/// What `peers.py` prints.
#[derive(Deserialize)]
#[serde(untagged)]
enum Answer {
    Done { seconds: f64, result: String },
    Missing { missing: String },
}

impl Peers {
    /// With this interpreter; with none nothing of others is run.
    pub fn new(python: Option<PathBuf>) -> Self {
        Peers { python }
    }

    /// Runs one of the functions of `peers.py` with an order; only its work is timed, not the start of Python.
    pub fn run(&self, name: &str, function: &str, order: &serde_json::Value) -> Run {
        let Some(python) = &self.python else {
            return Run::untimed(name, "not measured: no --python was given");
        };
        match ask(python, function, order) {
            Ok(Answer::Done { seconds, result }) => Run::timed(name, seconds, result),
            Ok(Answer::Missing { missing }) => Run::untimed(name, format!("not measured: {missing}")),
            Err(reason) => Run::untimed(name, format!("failed: {reason}")),
        }
    }
}

fn ask(python: &Path, function: &str, order: &serde_json::Value) -> Result<Answer, String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers.py");
    let mut child = Command::new(python)
        .arg(script)
        .arg(function)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| format!("{}: {error}", python.display()))?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(order.to_string().as_bytes()).map_err(|error| error.to_string())?;
    }
    let output = child.wait_with_output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let line = text.lines().last().ok_or_else(|| format!("{function} printed nothing"))?;
    serde_json::from_str(line).map_err(|error| format!("{function} printed {line}: {error}"))
}
