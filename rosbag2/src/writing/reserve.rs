//! Reserves disk space for closing a bag.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use crate::Error;

/// Bytes for the end of a file and for `metadata.yaml` with hundreds of topics.
const BYTES: usize = 128 * 1024;

/// An unnamed file that reserves space on the disk of the bag. The space is freed when it is dropped or when the
/// process is killed.
pub(super) struct Reserve {
    _file: File,
}

impl Reserve {
    /// Reserves the space.
    ///
    /// # Errors
    /// [`Error::NoSpace`], [`Error::Io`].
    pub fn take(folder: &Path) -> Result<Self, Error> {
        let taken = || {
            let mut file = tempfile::tempfile_in(folder)?;
            // Not zeros: some file systems do not store them.
            let block: Vec<u8> = (0..BYTES as u64).map(|index| (index.wrapping_mul(0x9e37_79b9) >> 16) as u8).collect();
            file.write_all(&block)?;
            file.sync_all()?;
            Ok::<_, std::io::Error>(file)
        };
        taken().map(|file| Reserve { _file: file }).map_err(|source| match source.kind() {
            std::io::ErrorKind::StorageFull | std::io::ErrorKind::QuotaExceeded => {
                Error::NoSpace { path: folder.to_path_buf(), bytes: 0, source }
            }
            _ => Error::io("write", folder)(source),
        })
    }
}
