//! Decompresses chunks on another core before the reader needs them.
//!
//! Decompression takes half of the time of reading a bag. The index lists where chunks begin, so a thread can
//! decompress the next chunk while the current one is read. Results are those of [`chunk::decompress`] for the same
//! bytes. The reader decompresses a chunk itself if this thread did not.

use std::path::Path;
use std::sync::mpsc::{Receiver, sync_channel};

use bytes::Bytes;
use mcap::records::op;

use super::chunk::{self, ChunkFault};
use super::framing::{RecordFile, RecordHead};
use crate::limits::ReadLimits;

/// Larger chunks are not decompressed ahead; bytes in the file. A recorder closes a chunk at 1 to 4 MB before
/// compression. Two chunks are buffered, which adds some megabytes to the memory of a reader.
const LARGEST: u64 = 4 << 20;
/// Chunks that are buffered besides the one in progress.
const WAITING: usize = 1;

/// A thread that decompresses the chunks of one file in order. It ends when this is dropped.
#[derive(Debug)]
pub(super) struct Ahead {
    chunks: Receiver<Unpacked>,
    next: Option<Unpacked>,
}

/// The decompressed chunk whose record has this head.
#[derive(Debug)]
struct Unpacked {
    offset: u64,
    length: u64,
    records: Result<Bytes, ChunkFault>,
}

impl Ahead {
    /// Starts with the chunks of the file at `path` at `offsets`, which ascend. `None` if there is no benefit: one
    /// chunk, one core, or no thread available.
    pub fn start(path: &Path, offsets: Vec<u64>, limits: ReadLimits) -> Option<Ahead> {
        if offsets.len() < 2 || std::thread::available_parallelism().map_or(1, usize::from) < 2 {
            return None;
        }
        let file = RecordFile::open(path, path).ok()?;
        let (sender, chunks) = sync_channel(WAITING);
        let unpack = move || {
            let _no_one_asks_any_more = unpack_all(file, &offsets, limits, |unpacked| sender.send(unpacked).ok());
        };
        std::thread::Builder::new().name("unpacking".into()).spawn(unpack).ok()?;
        Some(Ahead { chunks, next: None })
    }

    /// The records of the chunk with this head; `None` if it was not decompressed ahead. Callers request chunks in file
    /// order.
    pub fn take(&mut self, head: RecordHead) -> Option<Result<Bytes, ChunkFault>> {
        loop {
            let next = self.next.take().or_else(|| self.chunks.recv().ok())?;
            if next.offset > head.offset {
                self.next = Some(next);
                return None;
            }
            if next.offset == head.offset {
                return (next.length == head.length).then_some(next.records);
            }
        }
    }
}

/// Passes chunks to `take` until it returns `None`. The index is not trusted: no byte is decompressed twice, and no
/// more than a reader of the whole file would decompress.
fn unpack_all(
    mut file: RecordFile,
    offsets: &[u64],
    limits: ReadLimits,
    take: impl Fn(Unpacked) -> Option<()>,
) -> Option<()> {
    let mut sum = 0_u64;
    for &offset in offsets {
        if offset < file.position() {
            continue;
        }
        file.go_to(offset).ok()?;
        let head = file.record_head().ok()??;
        if head.opcode != op::CHUNK || head.length > LARGEST.min(limits.message).min(file.remaining()) {
            continue;
        }
        let records = chunk::decompress(Bytes::from(file.read(head.length).ok()?), limits.message);
        sum = sum.saturating_add(records.as_ref().map_or(0, Bytes::len) as u64);
        limits.check_unpacked(sum, file.length()).ok()?;
        take(Unpacked { offset: head.offset, length: head.length, records })?;
    }
    Some(())
}
