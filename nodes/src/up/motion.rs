//! The motion of `up --demo`: every cylinder follows a sine, repeatedly.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::Path;
use std::process::{Command, Stdio};

use excavator_model::Model;
use excavator_model::simulation::{Profile, Segment};
use excavator_workbench::profile_file::{ProfileFile, usual_rate};

use crate::error::VerbError;
use crate::sources;

/// Duration of the motion before it repeats, on a machine of the reference size, s.
const DURATION: f64 = 20.0;
/// Share of the largest opening: fast enough to be visible, far from the ends of the stroke.
const SHARE: f64 = 0.5;
/// Frequency on a machine of the reference size, Hz.
const FREQUENCY: f64 = 0.4;

/// A bag with commands. It is deleted when this value is dropped.
pub(super) struct Motion {
    folder: tempfile::TempDir,
}

impl Motion {
    /// Commands for a model, simulated by this program.
    ///
    /// # Errors
    /// [`VerbError`] for an unknown model, or one without a valve, and for a temporary folder that cannot be written.
    pub fn of(program: &Path, model: &str) -> Result<Self, VerbError> {
        let folder = tempfile::tempdir()?;
        let profile = folder.path().join("profile.toml");
        std::fs::write(&profile, profile_of(&sources::model_named(model)?)?)?;
        let mut command = Command::new(program);
        command.args(["simulate", "--quiet", "--model", model, "--input"]).arg(&profile).arg("-o");
        let status = command.arg(folder.path().join("motion")).stdout(Stdio::null()).status()?;
        if !status.success() {
            return Err(VerbError::PartFailed { part: "motion of the demo", status: status.to_string() });
        }
        Ok(Motion { folder })
    }

    /// The arguments of the player. The commands go to the namespace of the node.
    pub fn words(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = vec!["play".into(), self.folder.path().join("motion").into_os_string()];
        let rest =
            ["--topics", "/arm/orifice_command", "--remap", "/arm/orifice_command:=arm/orifice_command", "--loop"];
        words.extend(rest.map(OsString::from));
        words.extend(["--delay", "2"].map(OsString::from));
        words
    }
}

/// Sines for every cylinder that has a valve, each slower than the one before it, so that postures differ.
fn profile_of(model: &Model) -> Result<String, VerbError> {
    let unit = model.machine.size().time();
    let driven = model.machine.cylinders.iter().filter_map(|cylinder| Some((cylinder, cylinder.chambers?)));
    let profiles = driven.enumerate().map(|(number, (cylinder, chambers))| {
        let amplitude = SHARE * chambers.full_command();
        let frequency = FREQUENCY / (unit * (1 + number) as f64);
        let sine = Segment::Sine { duration: DURATION * unit, amplitude, frequency };
        Profile { cylinder: cylinder.name.clone(), segments: vec![sine] }
    });
    let file = ProfileFile { rate: usual_rate(), start: BTreeMap::new(), profiles: profiles.collect() };
    Ok(file.text(&["The motion of `excavator up --demo`.".to_string()])?)
}
