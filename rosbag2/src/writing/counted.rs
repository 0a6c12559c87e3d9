//! A file that counts what is written to it, and remembers why writing failed.

use std::fs::File;
use std::io::{self, Write};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Kind of an error of the operating system, and its number where it has one: errors themselves cannot be copied.
type Failure = (io::ErrorKind, Option<i32>);

/// What became of the bytes for a [`Counted`] file; clones share it.
#[derive(Debug, Clone, Default)]
pub(super) struct Progress {
    bytes: Arc<AtomicU64>,
    failure: Arc<Mutex<Option<Failure>>>,
}

impl Progress {
    /// Bytes that have left for the operating system.
    pub fn bytes(&self) -> u64 {
        self.bytes.load(Ordering::Relaxed)
    }

    /// The first error of the operating system.
    pub fn failure(&self) -> Option<io::Error> {
        let failure = *self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        failure.map(|(kind, number)| number.map_or_else(|| kind.into(), io::Error::from_raw_os_error))
    }

    fn fail(&self, error: &io::Error) {
        *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some((error.kind(), error.raw_os_error()));
    }
}

/// A file that counts what is written to it. After a failure it takes nothing more: what came after a gap would be no bag.
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

// The library asks for it, and does not seek when it is told not to.
impl io::Seek for Counted {
    fn seek(&mut self, position: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(position)
    }
}
