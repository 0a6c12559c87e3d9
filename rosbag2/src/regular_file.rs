//! Opens files only if they are regular: a FIFO blocks forever, a device never ends.

use std::fs::{File, FileType, OpenOptions};
use std::io::Read;
use std::path::Path;

use crate::Error;
use crate::limits::{Limit, LimitError};

/// Opens a regular file for reading, following symbolic links. Also returns its length in bytes.
///
/// FIFOs, devices, sockets and folders are rejected before they are opened, since opening alone can block or have side
/// effects. If the file is replaced in between, the replacement is rejected after opening.
///
/// # Errors
/// [`Error::NotARegularFile`], [`Error::Io`].
pub fn open_regular(path: &Path) -> Result<(File, u64), Error> {
    let before = std::fs::metadata(path).map_err(Error::io("open", path))?;
    check_kind(path, before.file_type())?;
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK | libc::O_NOCTTY | libc::O_CLOEXEC);
    let file = options.open(path).map_err(Error::io("open", path))?;
    let opened = file.metadata().map_err(Error::io("read", path))?;
    check_kind(path, opened.file_type())?;
    Ok((file, opened.len()))
}

/// Rejects anything that is not a regular file.
pub(crate) fn check_regular(path: &Path) -> Result<(), Error> {
    check_kind(path, std::fs::metadata(path).map_err(Error::io("open", path))?.file_type())
}

/// The bytes of a regular file of at most `most` bytes.
///
/// # Errors
/// [`Error::NotARegularFile`], [`Error::Io`]; [`Error::Limit`] for a larger file, which is not read.
pub fn read_regular(path: &Path, most: u64) -> Result<Vec<u8>, Error> {
    let (file, length) = open_regular(path)?;
    let refused = |source: LimitError| Error::Limit { path: path.to_path_buf(), source };
    Limit::Document.check(length, most).map_err(refused)?;
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or_default());
    // Files in /proc have length 0 but have content; others can grow.
    file.take(most.saturating_add(1)).read_to_end(&mut bytes).map_err(Error::io("read", path))?;
    Limit::Document.check(bytes.len() as u64, most).map_err(refused)?;
    Ok(bytes)
}

/// The text of a regular file of at most `most` bytes.
///
/// # Errors
/// As [`read_regular`]; also for text that is not UTF-8.
pub fn read_regular_text(path: &Path, most: u64) -> Result<String, Error> {
    String::from_utf8(read_regular(path, most)?).map_err(|error| {
        let reason = format!("it is not UTF-8 text: byte {} is wrong", error.utf8_error().valid_up_to());
        Error::io("read", path)(std::io::Error::new(std::io::ErrorKind::InvalidData, reason))
    })
}

fn check_kind(path: &Path, kind: FileType) -> Result<(), Error> {
    if kind.is_file() {
        return Ok(());
    }
    Err(Error::NotARegularFile { path: path.to_path_buf(), found: name_of(kind) })
}

fn name_of(kind: FileType) -> &'static str {
    if kind.is_dir() {
        return "a folder";
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return "a FIFO";
        }
        if kind.is_char_device() || kind.is_block_device() {
            return "a device";
        }
        if kind.is_socket() {
            return "a socket";
        }
    }
    "something else"
}

#[cfg(all(test, unix))]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn devices_and_folders_are_refused_and_sizes_are_bounded() -> std::io::Result<()> {
        for (path, found) in [("/dev/zero", "a device"), ("/", "a folder")] {
            let error = read_regular(Path::new(path), 10).unwrap_err();
            assert!(matches!(error, Error::NotARegularFile { found: kind, .. } if kind == found), "{error}");
        }
        let folder = tempfile::tempdir()?;
        let path = folder.path().join("file");
        std::fs::write(&path, [b'x'; 10])?;
        assert_eq!(read_regular(&path, 10).map(|bytes| bytes.len()).ok(), Some(10));
        let error = read_regular(&path, 9).unwrap_err().to_string();
        assert!(error.contains("10 bytes") && error.contains("limit for such a file is 9"), "{error}");
        std::fs::write(&path, [b'x', 0xff])?;
        assert!(read_regular_text(&path, 9).unwrap_err().to_string().contains("byte 1"));
        Ok(())
    }
}
