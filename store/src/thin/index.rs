//! Reads the index at the end of an MCAP file.

use std::io::SeekFrom;

use bytes::{Bytes, BytesMut};
use mcap::records::{Metadata, Record};
use mcap::sans_io::{SummaryReadEvent, SummaryReader, SummaryReaderOptions};
use mcap::{McapResult, Summary};

use super::source::Source;
use super::{Unfit, lengths};
use crate::StoreError;

/// Bytes fetched from the end at first: indexes of bags of a few minutes fit, and a smaller request would not be
/// faster.
const TAIL: u64 = 64 << 10;

/// Largest index, bytes.
const LARGEST: u64 = 256 << 20;

/// Bytes fetched from the beginning.
const HEAD: u64 = 512;

/// The index, and the records outside chunks.
pub(super) struct Index {
    pub(super) summary: Summary,
    /// Profile of the header, `ros2`.
    pub(super) profile: String,
    /// Offset of the first record after the header, bytes.
    pub(super) data_start: u64,
    /// Offset of the index, bytes.
    pub(super) end: u64,
    pub(super) metadata: Vec<Metadata>,
}

/// Reads the index with one to three requests, and one for each metadata record before the fetched end.
///
/// # Errors
/// [`StoreError`] of a request. The inner error states why the file does not allow a thin copy.
pub(super) async fn read(source: &Source<'_>) -> Result<Result<Index, Unfit>, StoreError> {
    let mut tail = Tail { start: source.size.saturating_sub(TAIL), bytes: Bytes::new() };
    tail.bytes = source.tail(tail.start).await?;
    let Some(start) = summary_start(&tail.bytes) else { return Ok(Err(Unfit("no index"))) };
    if start >= source.size || source.size - start > LARGEST {
        return Ok(Err(Unfit("an index at no possible place")));
    }
    if start < tail.start {
        let mut all = BytesMut::from(source.range(start..tail.start).await?.as_ref());
        all.extend_from_slice(&tail.bytes);
        tail = Tail { start, bytes: all.freeze() };
    }
    let Ok(Some(summary)) = summary(&tail, source.size) else { return Ok(Err(Unfit("an index that cannot be read"))) };
    let head = match tail.start {
        0 => tail.bytes.clone(),
        _ => source.range(0..HEAD.min(source.size)).await?,
    };
    let Some((profile, data_start)) = header(&head) else { return Ok(Err(Unfit("no header"))) };
    let mut metadata = Vec::new();
    for one in &summary.metadata_indexes {
        let Some(end) = one.offset.checked_add(one.length).filter(|end| *end <= source.size && one.length < LARGEST)
        else {
            return Ok(Err(Unfit("metadata at no possible place")));
        };
        let bytes = source.range(one.offset..end).await?;
        match lengths::record(&bytes) {
            Some((op, body)) => match mcap::parse_record(op, body) {
                Ok(Record::Metadata(found)) => metadata.push(found),
                _ => return Ok(Err(Unfit("metadata that cannot be read"))),
            },
            None => return Ok(Err(Unfit("metadata that cannot be read"))),
        }
    }
    Ok(Ok(Index { summary, profile, data_start, end: start, metadata }))
}

/// The end of a file.
struct Tail {
    start: u64,
    bytes: Bytes,
}

/// Offset of the index, from the footer: a record of 20 bytes before the last 8 bytes, which are the magic of every
/// file.
fn summary_start(tail: &[u8]) -> Option<u64> {
    let footer = tail.len().checked_sub(8 + 20 + 9)?;
    let (op, body) = lengths::record(tail.get(footer..)?)?;
    let ends_well = tail.ends_with(mcap::MAGIC);
    (op == mcap::records::op::FOOTER && ends_well).then(|| lengths::number(body)).flatten().filter(|start| *start > 0)
}

/// Parses the index in these bytes.
fn summary(tail: &Tail, size: u64) -> McapResult<Option<Summary>> {
    let mut reader = SummaryReader::new_with_options(
        SummaryReaderOptions::default().with_file_size(size).with_record_length_limit(LARGEST as usize),
    );
    let mut position = 0;
    while let Some(event) = reader.next_event() {
        match event? {
            SummaryReadEvent::SeekRequest(SeekFrom::Start(to)) => {
                position = to;
                reader.notify_seeked(to);
            }
            SummaryReadEvent::SeekRequest(_) => return Ok(None),
            SummaryReadEvent::ReadRequest(wanted) => {
                let from = position.checked_sub(tail.start).and_then(|from| usize::try_from(from).ok());
                let rest = from.and_then(|from| tail.bytes.get(from..)).unwrap_or_default();
                let count = wanted.min(rest.len());
                let (Some(place), Some(found)) = (reader.insert(wanted).get_mut(..count), rest.get(..count)) else {
                    return Ok(None);
                };
                place.copy_from_slice(found);
                reader.notify_read(count);
                position += count as u64;
            }
        }
    }
    Ok(reader.finish())
}

/// The profile of a file, and where its header ends.
fn header(head: &[u8]) -> Option<(String, u64)> {
    let after = head.strip_prefix(mcap::MAGIC)?;
    let (op, body) = lengths::record(after)?;
    let end = (mcap::MAGIC.len() + 9 + body.len()) as u64;
    match mcap::parse_record(op, body) {
        Ok(Record::Header(header)) => Some((header.profile, end)),
        _ => None,
    }
}
