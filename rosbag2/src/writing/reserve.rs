//! Room on the disk for closing a bag.

use std::fs::File;
use std::io::Write;
use std::path::Path;

use crate::Error;

/// Bytes for the end of a file and `metadata.yaml` with hundreds of topics.
const BYTES: usize = 128 * 1024;

/// A file without a name that holds room on the bag's disk. The room is free again when it is dropped, and when the process
/// is killed.
pub(super) struct Reserve {
    _file: File,
}

impl Reserve {
    /// Takes the room.
    ///
    /// # Errors
    /// [`Error::NoSpace`], [`Error::Io`].
    pub fn take(folder: &Path) -> Result<Self, Error> {
        let taken = || {
            let mut file = tempfile::tempfile_in(folder)?;
            // Not zeros, which some file systems do not store.
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
