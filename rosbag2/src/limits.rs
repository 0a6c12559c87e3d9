//! Limits on the cost of reading a file: one set for every reader.

use thiserror::Error;

/// The maximum cost of reading one file. Every reader takes its bounds from here. [`ReadLimits::default`] fits
/// recordings of machines, [`ReadLimits::untrusted`] fits files from an unknown sender.
///
/// A file chooses its own content, so a bound depends only on the actual size of the file, never on announced sizes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReadLimits {
    /// Memory that the values of one table or recording take, bytes. 1 GiB: 16 channels at 1 kHz for two hours are 0.9 GB.
    pub memory: u64,
    /// Memory that a file may use regardless of its size, bytes; beyond that [`ReadLimits::expansion`] applies. 32 MiB:
    /// four million values, so that a small file of constant columns can be read.
    pub least_memory: u64,
    /// Bytes in memory for each byte of the file, beyond [`ReadLimits::least_memory`]. 64: measured signals compress to
    /// a half or a tenth, a machine at rest to a thirtieth; only artificial data compresses to a thousandth, the limit
    /// of deflate.
    pub expansion: u64,
    /// Bytes processed for each byte of a file that is read piece by piece, beyond [`ReadLimits::memory`]. 1000: hours
    /// of a covered camera; a zstd bomb expands by a factor of 30 000.
    pub stream_expansion: u64,
    /// Size of one message, record or chunk, bytes after decompression. 64 MiB: an image of 8 megapixels has 25 MB, a
    /// recorder closes a chunk at 1 to 4 MB plus one message.
    pub message: u64,
    /// Size of all definitions and topic names of a bag, bytes. 64 MiB: two hundred topics with 50 kB of definitions
    /// are 10 MB.
    pub definitions: u64,
    /// Size of the definition of one topic, bytes. 1 MiB: the largest of the common packages have 200 kB.
    pub definition: u64,
    /// Nesting of types, or of groups. 32: messages of ROS 2 nest up to 8 deep.
    pub nesting: usize,
    /// Fields of a message with all contained types, variables of a file, or topics of a bag. 20 000: the largest message
    /// of the common packages has a few hundred.
    pub fields: usize,
    /// Size of a document: model, topic map, profile, `metadata.yaml`, bytes. 4 MiB: the metadata of a bag of ten
    /// thousand files has 2 MB.
    pub document: u64,
    /// Length of one line of a text table, bytes. 1 MiB: ten thousand columns of a hundred characters. A quote that is
    /// never closed turns the rest of the file into one line, which this limit stops.
    pub line: u64,
    /// Files of one bag. 1000: all are opened at the start, and a process may open 1024 files by default.
    pub files: usize,
    /// Steps of the SQLite virtual machine for one query. 20 million: about a second. A batch of a thousand rows takes
    /// 10 000.
    pub steps: u64,
}

impl Default for ReadLimits {
    fn default() -> Self {
        ReadLimits::DEFAULT
    }
}

impl ReadLimits {
    /// The limits for files that a local user chose.
    pub const DEFAULT: ReadLimits = ReadLimits {
        memory: 1 << 30,
        least_memory: 32 << 20,
        expansion: 64,
        stream_expansion: 1000,
        message: 64 << 20,
        definitions: 64 << 20,
        definition: 1 << 20,
        nesting: 32,
        fields: 20_000,
        document: 4 << 20,
        line: 1 << 20,
        files: 1000,
        steps: 20_000_000,
    };

    /// The limits for files chosen by somebody else, such as in the goal of a remote client: the reader stays below 200
    /// MB.
    #[must_use]
    pub const fn untrusted() -> ReadLimits {
        ReadLimits { memory: 96 << 20, message: 16 << 20, definitions: 16 << 20, ..ReadLimits::DEFAULT }
    }

    /// Memory that a file of this size may use, bytes.
    #[must_use]
    pub fn memory_of(&self, file_bytes: u64) -> u64 {
        self.memory.min(self.least_memory.saturating_add(self.expansion.saturating_mul(file_bytes)))
    }

    /// Checks the memory that a file of this size needs.
    ///
    /// # Errors
    /// [`LimitError`] with [`Limit::Memory`], or with [`Limit::Expansion`] if a larger file would be allowed as much.
    pub fn check_memory(&self, needed: u64, file_bytes: u64) -> Result<(), LimitError> {
        let allowed = self.memory_of(file_bytes);
        let limit = if allowed < self.memory { Limit::Expansion { file_bytes } } else { Limit::Memory };
        limit.check(needed, allowed)
    }

    /// Checks how many bytes a file of this size has produced so far when it is decompressed piece by piece.
    ///
    /// # Errors
    /// [`LimitError`] with [`Limit::Unpacked`].
    pub fn check_unpacked(&self, unpacked: u64, file_bytes: u64) -> Result<(), LimitError> {
        let allowed = self.memory.saturating_add(self.stream_expansion.saturating_mul(file_bytes));
        Limit::Unpacked { file_bytes }.check(unpacked, allowed)
    }
}

/// A bound of [`ReadLimits`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Limit {
    /// Memory that the values take.
    Memory,
    /// Memory that the values take, for a file of this size.
    Expansion {
        /// Bytes of the file.
        file_bytes: u64,
    },
    /// Bytes that a file of this size decompresses to, piece by piece.
    Unpacked {
        /// Bytes of the file.
        file_bytes: u64,
    },
    /// One message, record or chunk.
    Message,
    /// All definitions of a bag.
    Definitions,
    /// One definition.
    Definition,
    /// Nesting of types.
    Nesting,
    /// Fields, variables or topics.
    Fields,
    /// A document.
    Document,
    /// A line of a table.
    Line,
    /// Files of a bag.
    Files,
    /// Steps of SQLite.
    Steps,
}

impl Limit {
    /// Checks a number against the allowed maximum.
    ///
    /// # Errors
    /// [`LimitError`] when it is larger.
    pub fn check(self, found: u64, allowed: u64) -> Result<(), LimitError> {
        if found > allowed { Err(LimitError { limit: self, found, allowed }) } else { Ok(()) }
    }
}

/// A file that exceeds a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error("{}", self.text())]
pub struct LimitError {
    /// The limit.
    pub limit: Limit,
    /// The value in the file; if reading stopped at the limit, the amount read.
    pub found: u64,
    /// The allowed maximum.
    pub allowed: u64,
}

impl LimitError {
    fn text(&self) -> String {
        let LimitError { limit, found, allowed } = *self;
        match limit {
            Limit::Memory => {
                format!("its values need {found} bytes of memory, the limit is {allowed}; split it into parts")
            }
            Limit::Expansion { file_bytes } => format!(
                "a file of {file_bytes} bytes needs {found} bytes of memory, the limit for that size is {allowed}; \
                 it is broken or made to exhaust the reader"
            ),
            Limit::Unpacked { file_bytes } => format!(
                "a file of {file_bytes} bytes unpacks to {found} bytes or more, the limit for that size is {allowed}; \
                 it is made to exhaust the reader"
            ),
            Limit::Message => format!("a message, record or chunk has {found} bytes, the limit is {allowed}"),
            Limit::Definitions => {
                format!("the definitions of all topics together have {found} bytes, the limit is {allowed}")
            }
            Limit::Definition => format!("the definition of one topic has {found} bytes, the limit is {allowed}"),
            Limit::Nesting => format!("types are nested {found} deep, the limit is {allowed}"),
            Limit::Fields => format!("it has {found} fields, variables or topics, the limit is {allowed}"),
            Limit::Document => format!("it has {found} bytes or more, the limit for such a file is {allowed}"),
            Limit::Line => {
                format!("a line has more than {allowed} bytes ({found} read); a quote in it may never be closed")
            }
            Limit::Files => format!("the bag has {found} files, the limit is {allowed}"),
            Limit::Steps => {
                format!(
                    "SQLite did not answer within {allowed} steps ({found} taken); the database is made to be endless"
                )
            }
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn memory_grows_with_the_file_up_to_its_bound() {
        let limits = ReadLimits::DEFAULT;
        assert_eq!(limits.memory_of(0), 32 << 20);
        assert_eq!(limits.memory_of(1000), (32 << 20) + 64_000);
        assert_eq!(limits.memory_of(u64::MAX), 1 << 30);
        assert!(limits.check_memory(32 << 20, 0).is_ok());
        let error = limits.check_memory(1 << 30, 2_000_000).unwrap_err();
        assert_eq!(error.limit, Limit::Expansion { file_bytes: 2_000_000 });
        let line = error.to_string();
        for number in ["2000000", "1073741824", "161554432"] {
            assert!(line.contains(number), "{line}");
        }
        assert_eq!(limits.check_memory((1 << 30) + 1, 1 << 40).unwrap_err().limit, Limit::Memory);
    }
}
