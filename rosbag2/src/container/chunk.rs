//! Chunks: many records that share one compression and one checksum.

use std::io::Read;

use bytes::Bytes;
use thiserror::Error;

use super::fields::Fields;
use crate::limits::{Limit, LimitError};

/// First reservation for decompressed bytes: somewhat more than the chunk size of rosbag2 and of our writer.
const FIRST_RESERVATION: u64 = 1 << 20;

/// Chunks that announce at most this size are decompressed in one step without an intermediate buffer; bytes. The
/// announced size is reserved before any byte is seen, so it must be small: recorders close a chunk at 1 to 4 MB plus
/// one message.
const LARGEST_AT_ONCE: u64 = 8 << 20;

/// Why a chunk cannot be trusted.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub(super) enum ChunkFault {
    #[error("its head makes no sense")]
    BadHead,
    #[error("its compression \"{0}\" is not supported")]
    UnknownCompression(String),
    #[error("it announces {announced} bytes compressed, but has {available}")]
    Incomplete { announced: u64, available: u64 },
    #[error(transparent)]
    TooLarge(#[from] LimitError),
    #[error("it decompresses to {found} bytes instead of {announced}: {reason}")]
    Decompression { announced: u64, found: u64, reason: String },
    #[error("its checksum is {calculated:08x} instead of {saved:08x}")]
    Checksum { saved: u32, calculated: u32 },
}

struct ChunkHead<'b> {
    uncompressed_size: u64,
    checksum: u32,
    compression: &'b str,
    compressed_size: u64,
    content: &'b [u8],
}

impl<'b> ChunkHead<'b> {
    fn parse(record: &'b [u8]) -> Option<ChunkHead<'b>> {
        let mut fields = Fields(record);
        let _start_time = fields.u64()?;
        let _end_time = fields.u64()?;
        Some(ChunkHead {
            uncompressed_size: fields.u64()?,
            checksum: fields.u32()?,
            compression: fields.text()?,
            compressed_size: fields.u64()?,
            content: fields.0,
        })
    }
}

/// The records of a whole chunk of at most `most` bytes, checked against its size and checksum. A checksum of 0 means that
/// there is none.
pub(super) fn decompress(record: Bytes, most: u64) -> Result<Bytes, ChunkFault> {
    let head = ChunkHead::parse(&record).ok_or(ChunkFault::BadHead)?;
    let announced = head.uncompressed_size;
    Limit::Message.check(announced, most)?;
    let compressed = usize::try_from(head.compressed_size)
        .ok()
        .and_then(|size| head.content.get(..size))
        .ok_or(ChunkFault::Incomplete { announced: head.compressed_size, available: head.content.len() as u64 })?;
    let records = if head.compression.is_empty() {
        record.slice_ref(compressed)
    } else {
        let (records, fault) = inflate(head.compression, compressed, announced)?;
        if records.len() as u64 != announced {
            let reason = fault.unwrap_or_else(|| "the data ends early".to_string());
            return Err(ChunkFault::Decompression { announced, found: records.len() as u64, reason });
        }
        Bytes::from(records)
    };
    if records.len() as u64 != announced {
        let reason = "it is not compressed".to_string();
        return Err(ChunkFault::Decompression { announced, found: records.len() as u64, reason });
    }
    let saved = head.checksum;
    if saved != 0 {
        let calculated = crc32fast::hash(&records);
        if calculated != saved {
            return Err(ChunkFault::Checksum { saved, calculated });
        }
    }
    Ok(records)
}

/// Recovers what is readable from a chunk whose end is missing. Its checksum covers the missing part and cannot be
/// used. A writer that was killed leaves the sizes in the head unset (all ones), so they are not used either.
pub(super) fn salvage(record: Bytes, most: u64) -> Bytes {
    let Some(head) = ChunkHead::parse(&record) else {
        return Bytes::new();
    };
    if head.compression.is_empty() {
        return record.slice_ref(head.content);
    }
    match inflate(head.compression, head.content, head.uncompressed_size.min(most)) {
        Ok((records, _end_is_missing)) => Bytes::from(records),
        Err(_unknown_compression) => Bytes::new(),
    }
}

/// Decompresses up to `limit` bytes, and returns the reason if it stopped earlier.
///
/// The limit is the end, not the end of the compressed data: some writers pad the data with zeros.
fn inflate(compression: &str, compressed: &[u8], limit: u64) -> Result<(Vec<u8>, Option<String>), ChunkFault> {
    if compression == "zstd"
        && limit <= LARGEST_AT_ONCE
        && let Ok(records) = zstd::bulk::decompress(compressed, usize::try_from(limit).unwrap_or_default())
    {
        return Ok((records, None));
    }
    let mut records = Vec::with_capacity(usize::try_from(limit.min(FIRST_RESERVATION)).unwrap_or_default());
    let result = match compression {
        "zstd" => zstd::stream::read::Decoder::with_buffer(compressed)
            .and_then(|decoder| decoder.take(limit).read_to_end(&mut records)),
        "lz4" => lz4::Decoder::new(compressed).and_then(|decoder| decoder.take(limit).read_to_end(&mut records)),
        other => return Err(ChunkFault::UnknownCompression(other.to_string())),
    };
    Ok((records, result.err().map(|error| error.to_string())))
}
