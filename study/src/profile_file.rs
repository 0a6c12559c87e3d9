//! Profile files: commanded motion of each cylinder, as TOML.

use std::collections::BTreeMap;
use std::path::Path;

use excavator_model::document::{TomlFault, toml_fault};
use excavator_model::machine::Machine;
use excavator_model::simulation::{Profile, Segment};
use rosbag2::{ReadLimits, read_regular_text};
use serde::{Deserialize, Serialize};

use crate::WorkError;

/// Memory that a simulation may take, bytes.
const MOST_MEMORY: f64 = 1e9;

/// A value that exceeds a limit by less than this factor is the same number with fewer digits.
const ROUNDING: f64 = 1.001;

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

/// 1 kHz, the rate of the live simulator.
pub fn usual_rate() -> f64 {
    1000.0
}

/// Most samples of a simulated bag: an hour at 1 kHz with one cylinder, twenty minutes with five.
fn most_samples(cylinders: usize) -> f64 {
    // Commands and simulated recording with all signals, inputs of the integration, timestamps.
    let signals = 5 + 8 * cylinders;
    let numbers = 2 * signals + 4 + cylinders;
    (MOST_MEMORY / (8 * numbers) as f64).floor()
}

impl ProfileFile {
    /// Reads a file and checks it against a machine.
    ///
    /// # Errors
    /// [`WorkError`] in one line with the wrong number or name.
    pub fn read(path: &Path, machine: &Machine) -> Result<Self, WorkError> {
        ProfileFile::of_text(path, &read_regular_text(path, ReadLimits::DEFAULT.document)?, machine)
    }

    /// Parses the text of a file and checks it against a machine. `path` is for error messages.
    ///
    /// # Errors
    /// [`WorkError`] in one line with the wrong number or name.
    pub fn of_text(path: &Path, text: &str, machine: &Machine) -> Result<Self, WorkError> {
        let wrong = |fault: TomlFault| WorkError::ProfileSyntax { path: path.to_path_buf(), fault };
        let syntax = |reason: String| wrong(reason.into());
        let file: ProfileFile = toml::from_str(text).map_err(|error| wrong(toml_fault(text, &error)))?;
        if !(1.0..=100_000.0).contains(&file.rate) {
            return Err(syntax(format!("rate = {} must be between 1 and 100000 samples per second", file.rate)));
        }
        let names: Vec<&str> = machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
        for name in file.profiles.iter().map(|profile| &profile.cylinder).chain(file.start.keys()) {
            if !names.contains(&name.as_str()) {
                return Err(WorkError::ProfileCylinder {
                    machine: machine.name.clone(),
                    cylinder: name.clone(),
                    known: names.join(", "),
                });
            }
        }
        file.profiles.iter().try_for_each(Profile::check)?;
        file.check(names.len()).map_err(syntax)?;
        Ok(file)
    }

    /// Checks across segments and profiles, for a machine with this number of cylinders.
    fn check(&self, cylinders: usize) -> Result<(), String> {
        for (number, profile) in self.profiles.iter().enumerate() {
            let cylinder = &profile.cylinder;
            if self.profiles[..number].iter().any(|earlier| earlier.cylinder == *cylinder) {
                return Err(format!("{cylinder} has two profiles; put their segments into one"));
            }
            let frequency = profile.segments.iter().map(Segment::largest_frequency).fold(0.0, f64::max);
            if 2.0 * frequency > self.rate {
                let rate = self.rate;
                return Err(format!(
                    "{frequency} Hz cannot be shown by rate = {rate} samples per second; at least twice as many"
                ));
            }
        }
        let (duration, limit) = (self.duration(), most_samples(cylinders));
        if duration * self.rate > limit {
            return Err(format!(
                "{duration} s x {} samples per second are {:.3e} samples; the limit is {limit:.3e} with {cylinders} cylinders \
                 (1 GB of memory); make it shorter, or the rate lower",
                self.rate,
                duration * self.rate
            ));
        }
        Ok(())
    }

    /// Length of the longest profile, s.
    pub fn duration(&self) -> f64 {
        self.profiles.iter().map(Profile::duration).fold(0.0, f64::max)
    }

    /// Commands that `machine` cannot execute, one line per cylinder: openings beyond the full command of its valve.
    pub fn remarks(&self, machine: &Machine) -> Vec<String> {
        let opens_too_far = |profile: &Profile| {
            let cylinder = machine.cylinders.iter().find(|cylinder| cylinder.name == profile.cylinder)?;
            let drive = cylinder.chambers.as_ref()?.drive;
            let (maximum, (factor, unit)) = (drive.full_command(), drive.command_unit().for_people());
            let asked = profile.segments.iter().map(Segment::largest_area).fold(0.0, f64::max);
            (asked > ROUNDING * maximum).then(|| {
                format!(
                    "{}: asked to open {:.4} {unit} and the full command of {} is {:.4} {unit}; simulated as asked",
                    profile.cylinder,
                    factor * asked,
                    machine.name,
                    factor * maximum
                )
            })
        };
        self.profiles.iter().filter_map(opens_too_far).collect()
    }

    /// The text of the file, headed by the lines of `comment`.
    ///
    /// # Errors
    /// [`WorkError::ProfileWrite`] if a number cannot be written.
    pub fn text(&self, comment: &[String]) -> Result<String, WorkError> {
        let body = toml::to_string(self).map_err(|error| WorkError::ProfileWrite(error.to_string()))?;
        let head: String = comment.iter().map(|line| format!("# {line}\n")).collect();
        Ok(format!("{head}\n{body}"))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use excavator_model::document::built_in;

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
        let machine = built_in("zx30u-arm").unwrap().machine;
        assert_eq!(ProfileFile::read(&path, &machine).unwrap(), file);
        assert_eq!(file.remarks(&machine), Vec::<String>::new());
    }

    #[test]
    fn what_cannot_be_is_refused_and_what_the_valve_cannot_is_told() {
        let machine = built_in("zx30u-arm").unwrap().machine;
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("profile.toml");
        let read = |text: &str| {
            std::fs::write(&path, text).unwrap();
            ProfileFile::read(&path, &machine)
        };
        let one = |segment: &str| format!("[[profiles]]\ncylinder = \"arm\"\nsegments = [{segment}]\n");
        let sine = "{ kind = \"sine\", duration = 1.0, amplitude = 2e-4, frequency = 5.0 }";
        for (text, part) in [
            (format!("{}{}", one(sine), one(sine)), "arm has two profiles"),
            (format!("rate = 8.0\n{}", one(sine)), "5 Hz cannot be shown"),
            (
                one("{ kind = \"hold\", duration = 1e12, area = 0.0 }"),
                "1.000e15 samples; the limit is 4.032e6 with 1 cylinders",
            ),
            (one(""), "arm has no segments"),
        ] {
            let error = read(&text).unwrap_err().to_string();
            assert!(error.contains(part) && !error.contains('\n'), "{error}");
        }
        let remarks = read(&one(sine)).unwrap().remarks(&machine);
        assert!(remarks.len() == 1 && remarks[0].contains("asked to open 200.0000 mm2"), "{remarks:?}");
    }
}
