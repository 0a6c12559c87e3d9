//! A file that counts the bytes written to it, and stores the first write error.

use std::fs::File;
use std::io::{self, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Kind of an OS error, and its code if it has one: errors themselves cannot be cloned.
type Failure = (io::ErrorKind, Option<i32>);

/// The write progress of a [`Counted`] file; shared between clones.
#[derive(Debug, Clone, Default)]
pub(super) struct Progress {
    bytes: Arc<AtomicU64>,
    failure: Arc<Mutex<Option<Failure>>>,
}

impl Progress {
    /// Bytes passed to the operating system.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// The first OS error.
    pub fn failure(&self) -> Option<io::Error> {
        let failure = *self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        failure.map(|(kind, number)| number.map_or_else(|| kind.into(), io::Error::from_raw_os_error))
    }

    fn fail(&self, error: &io::Error) {
        *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some((error.kind(), error.raw_os_error()));
    }
}

/// A file that counts the bytes written to it. After a failure it rejects further writes: data after a gap would not be
/// a valid bag.
pub(super) struct Counted {
    file: File,
    progress: Progress,
}

impl Counted {
    pub fn new(file: File, progress: &Progress) -> Self {
        Counted { file, progress: progress.clone() }
    }

    fn outcome<T>(&self, outcome: io::Result<T>) -> io::Result<T> {
        if let Err(error) = &outcome
            && error.kind() != io::ErrorKind::Interrupted
        {
            self.progress.fail(error);
        }
        outcome
    }
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if let Some(failure) = self.progress.failure() {
            return Err(failure);
        }
        let count = self.file.write(bytes);
        let count = self.outcome(count)?;
        self.progress.bytes.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = self.file.flush();
        self.outcome(flushed)
    }
}

// The library requires the trait, but does not seek when seeking is disabled.
impl io::Seek for Counted {
    fn seek(&mut self, position: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}
