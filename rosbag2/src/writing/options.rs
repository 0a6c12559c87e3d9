//! How a bag is written.

use std::collections::BTreeMap;

/// Compression of the chunks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// None: fastest to write, three times as large.
    None,
    /// Fast, about half the size.
    Lz4,
    /// About a third of the size. The default: a disk that is full ends a recording, and 0.37 million messages per
    /// second are far more than a machine sends.
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

/// How a bag is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WriteOptions {
    /// Compression of the chunks.
    pub compression: Compression,
    /// Size at which a chunk is closed, bytes before compression. What is in an open chunk is lost with the power.
    pub chunk_size: u64,
    /// Size of a file after which the bag goes on in another one, bytes; `None`: one file however large.
    pub most_file_bytes: Option<u64>,
    /// Time between a file's first message and the one that goes into another file, ns; `None`: one file however long.
    pub most_file_nanoseconds: Option<u64>,
    /// Whether a bag of the same name is replaced by one that is made in a [`Staging`](crate::Staging). A
    /// [`BagWriter`](crate::BagWriter) alone never does.
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
