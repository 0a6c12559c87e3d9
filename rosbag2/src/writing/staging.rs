//! Builds a bag under a temporary name and renames it when it is complete.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use crate::Error;
use crate::metadata::FILE_NAME;

/// A folder next to the target in which a bag is built.
#[derive(Debug)]
#[must_use = "without `put_in_place`, what was made is removed"]
pub struct Staging {
    target: PathBuf,
    made: PathBuf,
    replace: bool,
    temporary: tempfile::TempDir,
}

impl Staging {
    /// Creates the folder. The target must not exist, or must be a bag if it is to be replaced.
    ///
    /// # Errors
    /// [`Error::AlreadyExists`], [`Error::NotReplaceable`], [`Error::NoName`], [`Error::Io`].
    pub fn beside(target: &Path, replace: bool) -> Result<Self, Error> {
        let name = target.file_name().ok_or_else(|| Error::NoName { path: target.to_path_buf() })?;
        if target.symlink_metadata().is_ok() {
            if !replace {
                return Err(Error::AlreadyExists { path: target.to_path_buf() });
            }
            check_replaceable(target)?;
        }
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        std::fs::create_dir_all(folder).map_err(Error::io("create", folder))?;
        let temporary = tempfile::Builder::new()
            .prefix(".excavator-")
            .tempdir_in(folder)
            .map_err(Error::io("create a folder in", folder))?;
        Ok(Staging { target: target.to_path_buf(), made: temporary.path().join(name), replace, temporary })
    }

    /// The path at which to build the bag.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.made
    }

    /// Renames the bag to its target.
    ///
    /// # Errors
    /// [`Error::AlreadyExists`] if the name has been taken since; [`Error::NotReplaceable`], [`Error::Io`].
    pub fn put_in_place(self) -> Result<(), Error> {
        let failed = |error: std::io::Error| match error.kind() {
            ErrorKind::AlreadyExists => Error::AlreadyExists { path: self.target.clone() },
            _ => Error::io("create", &self.target)(error),
        };
        if self.replace && self.target.symlink_metadata().is_ok() {
            check_replaceable(&self.target)?;
            let old = self.temporary.path().join("replaced");
            std::fs::rename(&self.target, &old).map_err(failed)?;
            return std::fs::rename(&self.made, &self.target).map_err(|error| {
                let _ = std::fs::rename(&old, &self.target);
                failed(error)
            });
        }
        // Creating the folder checks and takes the name in one step; the rename then replaces the empty folder
        // atomically.
        std::fs::create_dir(&self.target).map_err(failed)?;
        std::fs::rename(&self.made, &self.target).map_err(|error| {
            let _ = std::fs::remove_dir(&self.target);
            failed(error)
        })
    }

    /// The error with the target path of the bag.
    #[must_use]
    pub fn named(&self, error: Error) -> Error {
        let own = |path: PathBuf| path.strip_prefix(&self.made).map_or(path.clone(), |rest| self.target.join(rest));
        match error {
            Error::Io { action, path, source } => Error::Io { action, path: own(path), source },
            Error::Write { path, source } => Error::Write { path: own(path), source },
            Error::NoSpace { path, source, .. } => Error::io("write", &own(path))(source),
            other => other,
        }
    }
}

/// Checks that a bag may be replaced: a folder, not a link to one, that contains only files of a bag and its map.
///
/// # Errors
/// [`Error::NotReplaceable`], [`Error::Io`].
pub fn check_replaceable(folder: &Path) -> Result<(), Error> {
    let refused = |reason: String| Error::NotReplaceable { path: folder.to_path_buf(), reason };
    let found = folder.symlink_metadata().map_err(Error::io("read", folder))?;
    if !found.is_dir() {
        return Err(refused("it is not the folder of a bag".to_string()));
    }
    for entry in std::fs::read_dir(folder).map_err(Error::io("read", folder))? {
        let entry = entry.map_err(Error::io("read", folder))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        let is_part = [".mcap", ".db3", ".zstd", FILE_NAME, "map.toml"].iter().any(|end| name.ends_with(end));
        if !(is_file && is_part) {
            return Err(refused(format!("{name} in it is no part of a bag")));
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_bag_takes_its_name_when_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("bag");
        let make = |replace, content: &str| {
            let staging = Staging::beside(&target, replace)?;
            std::fs::create_dir(staging.folder()).unwrap();
            std::fs::write(staging.folder().join("bag_0.mcap"), content).unwrap();
            staging.put_in_place()
        };
        make(false, "one").unwrap();
        assert!(matches!(make(false, "two"), Err(Error::AlreadyExists { .. })));
        make(true, "three").unwrap();
        assert_eq!(std::fs::read_to_string(target.join("bag_0.mcap")).unwrap(), "three");
        std::fs::write(target.join("thesis.tex"), "text").unwrap();
        assert!(matches!(make(true, "four"), Err(Error::NotReplaceable { .. })));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing temporary stays");
    }

    #[test]
    fn a_name_that_was_taken_meanwhile_is_not_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("bag");
        let staging = Staging::beside(&target, false).unwrap();
        std::fs::create_dir(staging.folder()).unwrap();
        std::fs::create_dir(&target).unwrap();
        assert!(matches!(staging.put_in_place(), Err(Error::AlreadyExists { .. })));
    }
}
