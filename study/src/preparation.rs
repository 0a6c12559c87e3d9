//! Reads recordings by name and makes them fit for use.

use std::path::{Path, PathBuf};

use excavator_bags::ReadReport;
use excavator_bags::map::{Origin, read_recording_or_mapped};
use excavator_model::Model;
use excavator_model::recording::Recording;

use crate::long_recording::recording_or_stretches;
use crate::recording_part::Part;
use crate::recordings::{Use, checked, choice};
use crate::study::given_twice;
use crate::{Study, WorkError};

/// How recordings are found and used. Remarks for the user go to `remark`, also those that precede a failure.
#[derive(Clone, Copy)]
pub struct Preparation<'p> {
    /// Map and namespace.
    pub origin: Origin<'p>,
    /// Checks that are overruled, and conditions.
    pub usage: Use<'p>,
    /// Whether all of a long recording is used.
    pub whole: bool,
    /// Receives one line at a time.
    pub remark: &'p dyn Fn(&str),
}

impl Default for Preparation<'_> {
    /// Nothing is overruled or left out, and nobody listens to remarks.
    fn default() -> Self {
        Preparation { origin: Origin::default(), usage: Use::default(), whole: false, remark: &|_| () }
    }
}

impl Preparation<'_> {
    /// All of a recording, checked against the model. `BAG@20..40` is the part from 20 s to 40 s.
    ///
    /// # Errors
    /// [`WorkError`] if it cannot be read, or if a check refuses it.
    pub fn whole(&self, path: &Path, model: &Model) -> Result<Recording, WorkError> {
        self.whole_with_losses(path, model).map(|(recording, _)| recording)
    }

    fn whole_with_losses(&self, path: &Path, model: &Model) -> Result<(Recording, Vec<String>), WorkError> {
        let (whole, part) = Part::split(path)?;
        let (mut recording, report) = read_recording_or_mapped(&whole, self.origin)?;
        if let Some(part) = part {
            recording = part.of(&recording, path)?;
        }
        Ok((self.checked(path, recording, &report, model)?, report.lost_of_sources()))
    }

    /// A recording, checked against the model. Of a long one only the stretches that are most informative about the parameters of
    /// the model are read, unless all of it is wanted.
    ///
    /// # Errors
    /// As [`Preparation::whole`].
    pub fn recording(&self, path: &Path, model: &Model) -> Result<Recording, WorkError> {
        self.recording_with_losses(path, model).map(|(recording, _)| recording)
    }

    /// A recording, and what was lost of the messages that it rests on.
    fn recording_with_losses(&self, path: &Path, model: &Model) -> Result<(Recording, Vec<String>), WorkError> {
        if self.whole {
            return self.whole_with_losses(path, model);
        }
        let (recording, report, chosen) = recording_or_stretches(path, self.origin, model)?;
        if let Some(chosen) = &chosen {
            (self.remark)(&format!("{}: {}; --whole uses all", path.display(), choice(&recording, chosen)));
        }
        Ok((self.checked(path, recording, &report, model)?, report.lost_of_sources()))
    }

    /// Several recordings of one role.
    ///
    /// # Errors
    /// As [`Preparation::whole`], and if one is given twice.
    pub fn recordings(&self, paths: &[PathBuf], model: &Model) -> Result<Vec<Recording>, WorkError> {
        let all =
            paths.iter().map(|path| self.recording(path, model)).collect::<Result<Vec<Recording>, WorkError>>()?;
        let repeated = given_twice(&all.iter().collect::<Vec<_>>(), self.usage.accept)?;
        repeated.iter().for_each(|remark| (self.remark)(remark));
        Ok(all)
    }

    /// A study of recordings for the fit and others that judge. What they have in common is remarked.
    ///
    /// # Errors
    /// As [`Preparation::whole`], and if recordings are mostly the same.
    pub fn study(&self, model: Model, [fitted, judging]: [&[PathBuf]; 2]) -> Result<Study, WorkError> {
        let mut lost_messages = Vec::new();
        let mut read = |paths: &[PathBuf]| {
            let one = |path: &PathBuf| {
                let (recording, lost) = self.recording_with_losses(path, &model)?;
                let lines = lost.iter().map(|line| format!("{}: {line}", path.display()));
                lost_messages.extend(lines);
                Ok(recording)
            };
            paths.iter().map(one).collect::<Result<Vec<Recording>, WorkError>>()
        };
        let (fitted, judging) = (read(fitted)?, read(judging)?);
        let mut study = Study::new(model, fitted, judging);
        study.lost_messages = lost_messages;
        study.shared_readings(self.usage.accept)?.iter().for_each(|shared| (self.remark)(shared));
        Ok(study)
    }

    fn checked(
        &self,
        path: &Path,
        recording: Recording,
        report: &ReadReport,
        model: &Model,
    ) -> Result<Recording, WorkError> {
        let name = path.display().to_string();
        report.problems().iter().for_each(|problem| (self.remark)(&format!("{name}: {problem}")));
        let mut remarks = Vec::new();
        let used = checked(&name, recording, report, &self.usage, model, &mut remarks);
        remarks.iter().for_each(|line| (self.remark)(line));
        used
    }
}
