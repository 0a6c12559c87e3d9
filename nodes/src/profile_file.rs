//! Profile files: what each cylinder is asked to do, as TOML.

use std::collections::BTreeMap;
use std::path::Path;

use excavator_model::machine::Machine;
use excavator_model::simulation::Profile;
use serde::{Deserialize, Serialize};

use crate::error::VerbError;

/// A profile file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ProfileFile {
    /// Samples per second of the bag.
    #[serde(default = "usual_rate")]
    pub rate: f64,
    /// Piston displacement of each cylinder at the start, m from mid-stroke; zero where not given.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub start: BTreeMap<String, f64>,
    /// One profile per cylinder that moves.
    pub profiles: Vec<Profile>,
}

/// 1 kHz, as the live simulator publishes.
pub fn usual_rate() -> f64 {
    1000.0
}

impl ProfileFile {
    /// Reads a file and checks it against a machine.
    ///
    /// # Errors
    /// [`VerbError`] in one line that says which number or name is wrong.
    pub fn read(path: &Path, machine: &Machine) -> Result<Self, VerbError> {
        let text =
            std::fs::read_to_string(path).map_err(|source| VerbError::Read { path: path.to_path_buf(), source })?;
        let syntax = |reason: String| VerbError::ProfileSyntax { path: path.to_path_buf(), reason };
        let file: ProfileFile = toml::from_str(&text).map_err(|error| syntax(error.message().replace('\n', " ")))?;
        if !(1.0..=100_000.0).contains(&file.rate) {
            return Err(syntax(format!("rate = {} must be between 1 and 100000 samples per second", file.rate)));
        }
        let names: Vec<&str> = machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
        for name in file.profiles.iter().map(|profile| &profile.cylinder).chain(file.start.keys()) {
            if !names.contains(&name.as_str()) {
                return Err(VerbError::ProfileCylinder {
                    machine: machine.name.clone(),
                    cylinder: name.clone(),
                    known: names.join(", "),
                });
            }
        }
        file.profiles.iter().try_for_each(Profile::check)?;
        Ok(file)
    }

    /// The file's text, under comment lines that say what it is.
    ///
    /// # Errors
    /// [`VerbError::ProfileWrite`] when a number cannot be written.
    pub fn text(&self, comment: &[String]) -> Result<String, VerbError> {
        let body = toml::to_string(self).map_err(|error| VerbError::ProfileWrite(error.to_string()))?;
        let head: String = comment.iter().map(|line| format!("# {line}\n")).collect();
        Ok(format!("{head}\n{body}"))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;
    use excavator_model::simulation::Segment;

    #[test]
    fn what_is_written_is_read_back() {
        let segments = vec![
            Segment::Hold { duration: 0.5, area: 0.0 },
            Segment::Sine { duration: 4.0, amplitude: 5.75e-5, frequency: 0.5 },
            Segment::Sweep { duration: 5.0, amplitude: 3e-5, from_frequency: 0.5, to_frequency: 4.0 },
            Segment::Trapezoid { duration: 1.2, amplitude: -8e-5, ramp: 0.2 },
        ];
        let profiles = vec![Profile { cylinder: "arm".into(), segments }];
        let start = BTreeMap::from([("arm".to_string(), -0.05)]);
        let file = ProfileFile { rate: 500.0, start, profiles };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile.toml");
        std::fs::write(&path, file.text(&["one".into(), "two".into()]).unwrap()).unwrap();
        assert_eq!(ProfileFile::read(&path, &built_in("zx30u-arm").unwrap().machine).unwrap(), file);
    }
}
