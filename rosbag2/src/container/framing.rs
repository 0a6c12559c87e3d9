//! Reads the records of a file in sequence: one byte of opcode, eight of length, content.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crate::Error;
use crate::regular_file::open_regular;

/// Opcode and length.
pub(super) const HEADER_LENGTH: u64 = 9;

/// The head of a record whose content has not been read yet.
#[derive(Debug, Clone, Copy)]
pub(super) struct RecordHead {
    pub opcode: u8,
    /// Where the record begins, bytes from the start of the file.
    pub offset: u64,
    /// Length of the content in bytes, as announced.
    pub length: u64,
}

/// A file of records and the offset of the next record.
#[derive(Debug)]
pub(super) struct RecordFile {
    path: PathBuf,
    reader: BufReader<File>,
    position: u64,
    length: u64,
}

impl RecordFile {
    /// Opens the file at `path`; messages call it `name`.
    pub fn open(path: &Path, name: &Path) -> Result<RecordFile, Error> {
        let (file, length) = open_regular(path)?;
        Ok(RecordFile {
            path: name.to_path_buf(),
            reader: BufReader::with_capacity(1 << 16, file),
            position: 0,
            length,
        })
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes in the file.
    pub fn length(&self) -> u64 {
        self.length
    }

    /// Where the next read begins.
    pub fn position(&self) -> u64 {
        self.position
    }

    /// Bytes from here to the end.
    pub fn remaining(&self) -> u64 {
        self.length.saturating_sub(self.position)
    }

    pub fn go_to(&mut self, position: u64) -> Result<(), Error> {
        self.reader.seek(SeekFrom::Start(position)).map_err(Error::io("read", &self.path))?;
        self.position = position;
        Ok(())
    }

    /// Skips bytes; stops at the end of the file if it has fewer left.
    pub fn skip(&mut self, count: u64) -> Result<(), Error> {
        let target = self.position.saturating_add(count).min(self.length);
        // Relative seeks keep the buffer: message indexes are skipped by the thousand.
        let step = i64::try_from(target - self.position).unwrap_or(i64::MAX);
        self.reader.seek_relative(step).map_err(Error::io("read", &self.path))?;
        self.position = target;
        Ok(())
    }

    /// The next `count` bytes, or fewer at the end of the file.
    pub fn read(&mut self, count: u64) -> Result<Vec<u8>, Error> {
        let count = count.min(self.remaining());
        let mut bytes = Vec::with_capacity(usize::try_from(count).unwrap_or_default());
        let read = self.reader.by_ref().take(count).read_to_end(&mut bytes).map_err(Error::io("read", &self.path))?;
        self.position += read as u64;
        Ok(bytes)
    }

    /// The head of the next record; `None` when fewer bytes are left than a head has.
    pub fn record_head(&mut self) -> Result<Option<RecordHead>, Error> {
        if self.remaining() < HEADER_LENGTH {
            return Ok(None);
        }
        let offset = self.position;
        let mut head = [0; HEADER_LENGTH as usize];
        self.reader.read_exact(&mut head).map_err(Error::io("read", &self.path))?;
        self.position += HEADER_LENGTH;
        let [opcode, length @ ..] = head;
        Ok(Some(RecordHead { opcode, offset, length: u64::from_le_bytes(length) }))
    }
}

/// Parses the next record in memory and advances: opcode and range of its content.
///
/// `Ok(None)` at the end; `Err` with the number of bytes left if they are not a whole record.
pub(super) fn next_in_memory(
    bytes: &[u8],
    position: &mut usize,
) -> Result<Option<(u8, std::ops::Range<usize>)>, usize> {
    let Some(rest) = bytes.get(*position..).filter(|rest| !rest.is_empty()) else {
        return Ok(None);
    };
    let mut fields = super::fields::Fields(rest);
    let (Some(opcode), Some(length)) = (fields.u8(), fields.u64()) else {
        return Err(rest.len());
    };
    let start = *position + HEADER_LENGTH as usize;
    let end = usize::try_from(length).ok().and_then(|length| start.checked_add(length));
    match end {
        Some(end) if end <= bytes.len() => {
            *position = end;
            Ok(Some((opcode, start..end)))
        }
        _ => Err(rest.len()),
    }
}
