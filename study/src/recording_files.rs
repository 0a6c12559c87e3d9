//! The files of a recording, and whether they are still the same.

use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::WorkError;
use crate::recording_part::Part;

/// A recording by name and content.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordingFile {
    /// As it was named, with its part: `BAG@20..40`.
    pub path: PathBuf,
    /// SHA-256 of its files in the order of their names, in hexadecimal.
    pub sha256: String,
}

impl RecordingFile {
    /// Reads all files of a recording.
    ///
    /// # Errors
    /// [`WorkError::Part`] for an invalid part, [`WorkError::Unreadable`] if a file cannot be read.
    pub fn of(path: &Path) -> Result<Self, WorkError> {
        let (whole, _) = Part::split(path)?;
        let unreadable = |source| WorkError::Unreadable { path: whole.clone(), source };
        let sha256 = hash(&files(&whole).map_err(unreadable)?).map_err(unreadable)?;
        Ok(RecordingFile { path: path.to_path_buf(), sha256 })
    }

    /// Checks that the recording has the same content as when the study was made.
    ///
    /// # Errors
    /// [`WorkError::Changed`] if not; also as [`RecordingFile::of`].
    pub fn check(&self) -> Result<(), WorkError> {
        let now = RecordingFile::of(&self.path)?;
        if now.sha256 == self.sha256 { Ok(()) } else { Err(WorkError::Changed { path: self.path.clone() }) }
    }
}

/// The file itself, or the files directly in a folder by name.
fn files(whole: &Path) -> io::Result<Vec<PathBuf>> {
    if !whole.is_dir() {
        return Ok(vec![whole.to_path_buf()]);
    }
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(whole)?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
    files.retain(|path| path.is_file());
    files.sort();
    Ok(files)
}

fn hash(files: &[PathBuf]) -> io::Result<String> {
    let mut hash = Sha256::new();
    for file in files {
        io::copy(&mut File::open(file)?, &mut hash)?;
    }
    Ok(hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_changed_recording_is_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let bag = folder.path().join("bag");
        std::fs::create_dir(&bag).unwrap();
        std::fs::write(bag.join("bag_0.mcap"), "abc").unwrap();
        let file = RecordingFile::of(&bag).unwrap();
        // FIPS 180-2, appendix B.1.
        assert_eq!(file.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
        assert!(file.check().is_ok());
        std::fs::write(bag.join("metadata.yaml"), "d").unwrap();
        assert!(matches!(file.check(), Err(WorkError::Changed { .. })));
        let part = RecordingFile::of(&bag.with_file_name("bag@1..2")).unwrap();
        assert_ne!(part.sha256, file.sha256);
        assert!(part.check().is_ok());
    }
}
