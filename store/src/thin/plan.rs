//! Plans which parts of a file are fetched.

use std::collections::BTreeSet;
use std::ops::Range;

use mcap::records::ChunkIndex;

use super::index::Index;
use super::{Unfit, Wanted};

/// Chunks closer together than this are fetched with one request, bytes. Between two of them are message indexes, and a
/// request costs more than fetching these bytes.
const GAP: u64 = 64 << 10;

/// Limit for one request, bytes; a single chunk may be larger.
const TOGETHER: u64 = 8 << 20;

/// Largest chunk, bytes, compressed and uncompressed: four of them are in memory at a time.
const LARGEST_CHUNK: u64 = 512 << 20;

/// What is fetched with one request.
pub(super) struct Fetch {
    pub(super) range: Range<u64>,
    /// The chunks with wanted messages, as ranges of the fetched bytes.
    pub(super) chunks: Vec<Range<usize>>,
}

/// Wanted channels and the requests for them.
pub(super) struct Plan {
    /// Numbers of the wanted channels.
    pub(super) channels: BTreeSet<u16>,
    pub(super) fetches: Vec<Fetch>,
}

/// The parts of a file that the wanted topics need.
///
/// # Errors
/// [`Unfit`] if the index does not locate all messages.
pub(super) fn plan(index: &Index, wanted: &Wanted<'_>) -> Result<Plan, Unfit> {
    let summary = &index.summary;
    let channels: BTreeSet<u16> =
        summary.channels.iter().filter(|(_, channel)| wanted.has(&channel.topic)).map(|(id, _)| *id).collect();
    if channels.len() == summary.channels.len() {
        return Err(Unfit("every topic is wanted"));
    }
    let mut chunks: Vec<&ChunkIndex> = summary.chunk_indexes.iter().collect();
    chunks.sort_by_key(|chunk| chunk.chunk_start_offset);
    check_coverage(index, &chunks)?;
    let mut fetches: Vec<Fetch> = Vec::new();
    for chunk in chunks {
        let known = chunk.message_index_offsets.keys();
        if known.clone().any(|id| !summary.channels.contains_key(id)) {
            return Err(Unfit("an index that lacks a channel"));
        }
        // A chunk without message indexes may have messages of any topic.
        if !chunk.message_index_offsets.is_empty() && !known.clone().any(|id| channels.contains(id)) {
            continue;
        }
        if chunk.chunk_length > LARGEST_CHUNK || chunk.uncompressed_size > LARGEST_CHUNK {
            return Err(Unfit("a chunk that is too large for the memory"));
        }
        add(&mut fetches, chunk.chunk_start_offset..chunk.chunk_start_offset + chunk.chunk_length)?;
    }
    Ok(Plan { channels, fetches })
}

/// Adds a chunk to the last fetch, or starts a new one.
fn add(fetches: &mut Vec<Fetch>, chunk: Range<u64>) -> Result<(), Unfit> {
    let within = |range: &Range<u64>| -> Result<Range<usize>, Unfit> {
        let place = |at: u64| usize::try_from(at - range.start).map_err(|_| Unfit("a chunk at no possible place"));
        Ok(place(chunk.start)?..place(chunk.end)?)
    };
    if let Some(last) = fetches.last_mut()
        && chunk.start - last.range.end <= GAP
        && chunk.end - last.range.start <= TOGETHER
    {
        last.range.end = chunk.end;
        let place = within(&last.range)?;
        last.chunks.push(place);
        return Ok(());
    }
    let place = within(&chunk)?;
    fetches.push(Fetch { range: chunk, chunks: vec![place] });
    Ok(())
}

/// Checks that chunks with their indexes, attachments and metadata fill the file. Otherwise there may be messages
/// outside chunks.
fn check_coverage(index: &Index, chunks: &[&ChunkIndex]) -> Result<(), Unfit> {
    let summary = &index.summary;
    let mut known: Vec<(u64, u64)> = chunks
        .iter()
        .map(|one| (one.chunk_start_offset, one.chunk_length.saturating_add(one.message_index_length)))
        .collect();
    known.extend(summary.attachment_indexes.iter().map(|one| (one.offset, one.length)));
    known.extend(summary.metadata_indexes.iter().map(|one| (one.offset, one.length)));
    known.sort_unstable();
    let mut covered = index.data_start;
    for (start, length) in known {
        if start != covered {
            return Err(Unfit("records outside chunks"));
        }
        covered = start.checked_add(length).ok_or(Unfit("an index at no possible place"))?;
    }
    // The DataEnd record has 13 bytes.
    if covered.checked_add(13) == Some(index.end) { Ok(()) } else { Err(Unfit("records outside chunks")) }
}
