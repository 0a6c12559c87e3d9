//! Rows of the table of faults.

use std::path::PathBuf;

use serde::Serialize;

/// Something that was tried, and what happens now.
#[derive(Debug, Serialize)]
pub struct Fault {
    /// Heading of the table: "Commands", "Network", "Remote goals", "Files", "Recorder", "Pages and bridges".
    pub group: &'static str,
    /// What is tried, as a short clause: "an operator falls silent while another one goes on".
    pub tried: &'static str,
    /// What happens, as a short clause: "its valve closes within the lease; the other one's stays".
    pub outcome: &'static str,
}

#[derive(Serialize)]
struct Row<'f> {
    #[serde(flatten)]
    fault: &'f Fault,
    measured: Vec<(&'f str, String)>,
}

impl Fault {
    /// Writes the row, to be called at the end of the test, with what was measured: name with unit, and number.
    pub fn survived(&self, measured: &[(&str, String)]) {
        let folder = folder();
        std::fs::create_dir_all(&folder).unwrap();
        let name: String =
            self.tried.chars().map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '-' }).collect();
        let row = Row { fault: self, measured: measured.to_vec() };
        std::fs::write(folder.join(format!("{name:.80}.json")), serde_json::to_string_pretty(&row).unwrap()).unwrap();
    }
}

/// Where the rows are collected: `$EXCAVATOR_FAULTS`, or `target/faults`.
fn folder() -> PathBuf {
    std::env::var_os("EXCAVATOR_FAULTS")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/faults")), PathBuf::from)
}
