//! `BAG@20..40`: a part of a recording, by seconds after its first sample.

use std::path::{Path, PathBuf};

use excavator_model::recording::Recording;

use crate::WorkError;

/// Start and end, s after the first sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    from: f64,
    to: f64,
}

impl Part {
    /// Splits a path into the bag and the wanted part. A path that exists as written has no part, even with an @ in its
    /// name.
    ///
    /// ```
    /// use std::path::Path;
    ///
    /// use excavator_study::recording_part::Part;
    ///
    /// let (bag, part) = Part::split(Path::new("drive_1@20..40"))?;
    /// assert_eq!(bag, Path::new("drive_1"));
    /// assert!(part.is_some());
    /// # Ok::<(), excavator_study::WorkError>(())
    /// ```
    ///
    /// # Errors
    /// [`WorkError::Part`] for invalid times.
    pub fn split(path: &Path) -> Result<(PathBuf, Option<Part>), WorkError> {
        let named = || {
            let (before, part) = path.to_str()?.rsplit_once('@')?;
            Some((before, part.split_once("..")?))
        };
        let Some((before, (from, to))) = named().filter(|_| !path.exists()) else {
            return Ok((path.to_path_buf(), None));
        };
        let time = |text: &str, open: f64| match text.parse::<f64>() {
            _ if text.is_empty() => Ok(open),
            Ok(time) if time.is_finite() && time >= 0.0 => Ok(time),
            _ => Err(wrong(path, format!("\"{text}\" is no number of seconds after the first sample"))),
        };
        let (from, to) = (time(from, 0.0)?, time(to, f64::INFINITY)?);
        Ok((PathBuf::from(before), Some(Part::between(from, to, path)?)))
    }

    /// The part of a recording from `from` to `to`, s. Error messages call it `name`.
    ///
    /// # Errors
    /// [`WorkError::Part`] for an end that is not after the start.
    pub fn between(from: f64, to: f64, name: &Path) -> Result<Part, WorkError> {
        // Also false if one of them is NaN.
        let is_part = from >= 0.0 && from < to;
        if is_part { Ok(Part { from, to }) } else { Err(wrong(name, format!("{from} s is not before {to} s"))) }
    }

    /// The wanted samples of a block that begins `offset` s after the first sample of its recording; `None` if there
    /// are none.
    pub fn of_block(self, block: &Recording, offset: f64) -> Option<Recording> {
        let part = block.part(self.from - offset, self.to - offset);
        (!part.is_empty()).then_some(part)
    }

    /// Whether the part ends before `time`, s.
    pub fn ends_before(self, time: f64) -> bool {
        self.to < time
    }

    /// The error if the recording from `path` ends at `end`, s, before the part begins.
    pub fn is_beyond(self, end: f64, path: &Path) -> WorkError {
        wrong(path, format!("the recording ends at {end:.2} s"))
    }

    /// The part of a recording that was read from `path`.
    ///
    /// # Errors
    /// [`WorkError::Part`] if the recording ends before the part begins.
    pub fn of(self, recording: &Recording, path: &Path) -> Result<Recording, WorkError> {
        if self.from >= recording.duration() {
            return Err(self.is_beyond(recording.duration(), path));
        }
        let mut part = recording.part(self.from, self.to);
        part.source = path.display().to_string();
        Ok(part)
    }
}

fn wrong(path: &Path, reason: String) -> WorkError {
    WorkError::Part { path: path.to_path_buf(), reason }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn split(text: &str) -> Result<(PathBuf, Option<Part>), String> {
        Part::split(Path::new(text)).map_err(|error| error.to_string())
    }

    #[test]
    fn parts_are_told_from_names() {
        let with = |from, to| Ok((PathBuf::from("bag"), Some(Part { from, to })));
        assert_eq!(split("bag@20..40"), with(20.0, 40.0));
        assert_eq!(split("bag@..2.5"), with(0.0, 2.5));
        assert_eq!(split("bag@2..").unwrap().1.unwrap().to, f64::INFINITY);
        assert_eq!(split("bag"), Ok((PathBuf::from("bag"), None)));
        assert_eq!(split("a@b/bag@2..").unwrap().0, PathBuf::from("a@b/bag"));
        assert_eq!(split("me@home"), Ok((PathBuf::from("me@home"), None)));
    }

    #[test]
    fn times_that_are_none_are_told() {
        for (text, part) in [("bag@nan..5", "\"nan\""), ("bag@-1..5", "\"-1\""), ("bag@5..2", "5 s is not before 2 s")]
        {
            let error = split(text).unwrap_err();
            assert!(error.contains(text) && error.contains(part), "{error}");
        }
        let recording = Recording::unmeasured("bag", vec![0.0, 1.0, 2.0], &["arm"]);
        let (_, part) = split("bag@9..").unwrap();
        let error = part.unwrap().of(&recording, Path::new("bag@9..")).unwrap_err().to_string();
        assert!(error.contains("ends at 2.00 s"), "{error}");
    }
}
