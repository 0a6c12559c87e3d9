//! The input files of a command.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use excavator_bags::map::TopicMap;
use excavator_study::recording_part::Part;

use super::place::FileId;

/// The input files of a command, by their identity on the disk.
#[derive(Debug, Default)]
pub struct Inputs {
    files: BTreeSet<FileId>,
}

impl Inputs {
    /// A recording: a file, or a folder with all files directly in it that may be part of a bag.
    pub fn recording(path: &Path) -> Self {
        let mut inputs = Inputs::default();
        inputs.add_recording(path);
        inputs
    }

    /// Recordings with their map: the given one, or those beside them.
    pub fn recordings<'p>(paths: impl IntoIterator<Item = &'p PathBuf>, map: Option<&Path>) -> Self {
        let mut inputs = Inputs::default();
        for path in paths {
            let whole = inputs.add_recording(path);
            if map.is_none()
                && let Some(map) = TopicMap::beside(&whole)
            {
                inputs.add(&map);
            }
        }
        map.iter().for_each(|map| inputs.add(map));
        inputs
    }

    /// Adds a file. The name of a built-in model adds nothing.
    #[must_use]
    pub fn and(mut self, file: impl AsRef<Path>) -> Self {
        self.add(file.as_ref());
        self
    }

    /// The union with other inputs.
    #[must_use]
    pub fn and_all(self, files: impl IntoIterator<Item = PathBuf>) -> Self {
        files.into_iter().fold(self, Inputs::and)
    }

    /// Whether this file is an input.
    pub fn has(&self, id: FileId) -> bool {
        self.files.contains(&id)
    }

    /// Whether the two share a file.
    pub fn meets(&self, other: &Inputs) -> bool {
        !self.files.is_disjoint(&other.files)
    }

    fn add_recording(&mut self, path: &Path) -> PathBuf {
        let whole = Part::split(path).map_or_else(|_| path.to_path_buf(), |(whole, _)| whole);
        self.add(&whole);
        for entry in std::fs::read_dir(&whole).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().to_lowercase();
            if [".mcap", ".db3", ".zstd", "metadata.yaml"].iter().any(|end| name.ends_with(end)) {
                self.add(&entry.path());
            }
        }
        whole
    }

    fn add(&mut self, path: &Path) {
        // The reader reports a file that does not exist.
        if let Ok(found) = path.metadata() {
            self.files.insert(FileId::of(&found));
        }
    }
}
