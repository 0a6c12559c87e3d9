//! Options for writing a bag.

use std::collections::BTreeMap;

/// Compression of the chunks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// None: fastest to write, three times as large.
    None,
    /// Fast, about half the size.
    Lz4,
    /// About a third of the size. The default: a full disk ends a recording, and 0.37 million messages per second are
    /// far more than a machine sends.
    #[default]
    Zstd,
}

impl Compression {
    pub(crate) fn to_mcap(self) -> Option<mcap::Compression> {
        match self {
            Compression::None => None,
            Compression::Lz4 => Some(mcap::Compression::Lz4),
            Compression::Zstd => Some(mcap::Compression::Zstd),
        }
    }
}

/// Options for writing a bag.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WriteOptions {
    /// Compression of the chunks.
    pub compression: Compression,
    /// Size at which a chunk is closed, bytes before compression. A power cut loses the open chunk.
    pub chunk_size: u64,
    /// File size after which the bag continues in another file, bytes; `None`: one file of any size.
    pub most_file_bytes: Option<u64>,
    /// Time between the first message of a file and the first message of the next file, ns; `None`: one file of any
    /// duration.
    pub most_file_nanoseconds: Option<u64>,
    /// Whether a bag of the same name is replaced by one made in a [`Staging`](crate::Staging). A
    /// [`BagWriter`](crate::BagWriter) alone never replaces a bag.
    pub replace: bool,
    /// Pairs for `custom_data` in `metadata.yaml`, which `ros2 bag info` shows.
    pub custom_data: BTreeMap<String, String>,
}

impl Default for WriteOptions {
    /// Zstd, chunks of 768 KiB as rosbag2 writes them, one file, no custom data.
    fn default() -> Self {
        WriteOptions {
            compression: Compression::default(),
            chunk_size: 768 * 1024,
            most_file_bytes: None,
            most_file_nanoseconds: None,
            replace: false,
            custom_data: BTreeMap::new(),
        }
    }
}
