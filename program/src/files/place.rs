//! Classifies the target path of an output.

use std::io::{Error, ErrorKind};
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::Path;

use crate::error::VerbError;

/// Device and inode of a file: the same for all its names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct FileId(u64, u64);

impl FileId {
    pub fn of(found: &std::fs::Metadata) -> Self {
        FileId(found.dev(), found.ino())
    }
}

/// The kind of a path's target.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Standard output, a pipe or a character device.
    Stream,
    /// A file.
    File(FileId),
    /// Nothing.
    Free,
}

/// Folders whose links lead to files that the process has open: `/dev/stdout`, `/dev/fd/63` of `>(command)`.
const OPEN_FILES: [&str; 4] = ["/dev", "/dev/fd", "/proc/self/fd", "/proc/thread-self/fd"];

impl Place {
    /// Inspects a path without following a link.
    ///
    /// # Errors
    /// [`VerbError::Link`]; [`VerbError::Write`] if the target is neither a file nor a stream.
    pub fn of(path: &Path) -> Result<Place, VerbError> {
        if path == Path::new("-") {
            return Ok(Place::Stream);
        }
        let found = match path.symlink_metadata() {
            Ok(found) => found,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Place::Free),
            Err(error) => return Err(VerbError::write(path)(error)),
        };
        let kind = found.file_type();
        if kind.is_symlink() && is_open_file(path) {
            return Ok(Place::Stream);
        }
        if kind.is_symlink() {
            return Err(VerbError::Link { path: path.to_path_buf() });
        }
        if kind.is_fifo() || kind.is_char_device() {
            return Ok(Place::Stream);
        }
        if kind.is_dir() {
            return Err(VerbError::write(path)(Error::from(ErrorKind::IsADirectory)));
        }
        if !kind.is_file() {
            return Err(VerbError::write(path)(Error::other("it is a block device or a socket")));
        }
        Ok(Place::File(FileId::of(&found)))
    }
}

/// Whether the path is a link to a file that this process has open.
pub fn is_open_file(path: &Path) -> bool {
    path.parent().is_some_and(|folder| OPEN_FILES.iter().any(|open| folder == Path::new(open)))
}

/// The folder of a path.
pub fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}
