//! Reads the messages of one MCAP file in the order in which they were written.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use bytes::Bytes;
use mcap::records::op;

use super::ahead::Ahead;
use super::chunk::{self, ChunkFault};
use super::damage::{Damage, DamageKind};
use super::damage_list::DamageList;
use super::fields::MessageHeader;
use super::framing::{HEADER_LENGTH, RecordFile, RecordHead, next_in_memory};
use super::registry::Registry;
use super::summary::Summary;
use crate::Error;
use crate::limits::{Limit, ReadLimits};
use crate::raw_message::{RawMessage, Topic};

/// One open file.
#[derive(Debug)]
pub(crate) struct McapFile {
    file: RecordFile,
    registry: Registry,
    summary: Option<Summary>,
    /// Chunks that another core decompresses, started at the first chunk; the inner `None` means that there is no
    /// benefit.
    ahead: Option<Option<Ahead>>,
    opened: PathBuf,
    /// Whether the file has the end of a closed file, with or without summary.
    closed: bool,
    chunk: Option<OpenChunk>,
    damage: DamageList,
    /// Bytes decompressed from chunks so far.
    unpacked: u64,
    last_log_time: Option<u64>,
    unknown_topic: UnknownTopic,
    finished: bool,
    limits: ReadLimits,
}

/// A decompressed chunk and how far it has been read.
#[derive(Debug)]
struct OpenChunk {
    offset: u64,
    records: Bytes,
    position: usize,
    /// Set when the end of the chunk is missing: the messages recovered so far, and the damage to report.
    cut: Option<Damage>,
    recovered: u64,
}

/// Messages that refer to a topic that no readable record defines.
#[derive(Debug, Default)]
struct UnknownTopic {
    messages: u64,
    bytes: u64,
    first_offset: u64,
}

impl McapFile {
    /// Opens the file at `path`, which messages call `name`, and reads its summary, if it has one. `None` if it is not
    /// an MCAP file.
    pub fn open(path: &Path, name: &Path, limits: &ReadLimits) -> Result<Option<McapFile>, Error> {
        let mut file = RecordFile::open(path, name)?;
        if file.read(mcap::MAGIC.len() as u64)? != mcap::MAGIC {
            return Ok(None);
        }
        let mut registry = Registry::new(limits);
        let summary = Summary::read(&mut file, &mut registry, limits)?;
        let magic_length = mcap::MAGIC.len() as u64;
        file.go_to(file.length().saturating_sub(magic_length).max(magic_length))?;
        let closed = file.read(magic_length)? == mcap::MAGIC;
        file.go_to(magic_length)?;
        Ok(Some(McapFile {
            file,
            registry,
            summary,
            ahead: None,
            opened: path.to_path_buf(),
            closed,
            chunk: None,
            damage: DamageList::default(),
            unpacked: 0,
            last_log_time: None,
            unknown_topic: UnknownTopic::default(),
            finished: false,
            limits: *limits,
        }))
    }

    /// The topics known so far: all topics if there is a summary, otherwise those already seen.
    pub fn topics(&self) -> impl Iterator<Item = &Arc<Topic>> {
        self.registry.topics()
    }

    /// Whether the file ends with a valid index.
    pub fn has_index(&self) -> bool {
        self.summary.is_some() && self.closed
    }

    /// The damage found so far; complete once [`McapFile::next_message`] has returned `None`.
    pub fn damage(&self) -> &[Damage] {
        self.damage.as_slice()
    }

    /// The next message, `None` at the end. Damage is recorded and skipped.
    ///
    /// # Errors
    /// Only errors of the operating system.
    pub fn next_message(&mut self) -> Result<Option<RawMessage>, Error> {
        while !self.finished {
            let message = match self.chunk.take() {
                Some(chunk) => self.next_in_chunk(chunk),
                None => self.next_outside_chunks()?,
            };
            if let Some(message) = message {
                self.last_log_time = Some(message.log_time);
                return Ok(Some(message));
            }
        }
        Ok(None)
    }

    /// Continues in the chunk and puts it back if it has more; `None` if the next record is not a message.
    fn next_in_chunk(&mut self, mut chunk: OpenChunk) -> Option<RawMessage> {
        // A chunk can consist of seven million empty, useless records: they are skipped here.
        let next = loop {
            match next_in_memory(&chunk.records, &mut chunk.position) {
                Ok(Some((opcode, _))) if !matches!(opcode, op::MESSAGE | op::SCHEMA | op::CHANNEL) => {}
                next => break next,
            }
        };
        match next {
            Ok(Some((opcode, range))) => {
                let message = self.in_memory_record(opcode, &chunk.records, range, chunk.offset);
                chunk.recovered += u64::from(message.is_some());
                self.chunk = Some(chunk);
                message
            }
            Ok(None) => {
                self.close_chunk(chunk);
                None
            }
            Err(left) => {
                if chunk.cut.is_none() {
                    let reason = format!("its last {left} bytes are no whole record");
                    self.note(chunk.offset, left as u64, DamageKind::BadChunk { reason });
                }
                self.close_chunk(chunk);
                None
            }
        }
    }

    fn close_chunk(&mut self, chunk: OpenChunk) {
        if let Some(mut cut) = chunk.cut {
            cut.kind = DamageKind::CutOff { recovered_messages: chunk.recovered };
            cut.readable_until = self.last_log_time;
            self.damage.push(cut);
            self.finish();
        }
    }

    /// Returns a message if the record is one. Registers definitions and ignores all other records.
    fn in_memory_record(
        &mut self,
        opcode: u8,
        records: &Bytes,
        range: Range<usize>,
        offset: u64,
    ) -> Option<RawMessage> {
        let content = records.get(range.clone())?;
        let length = content.len() as u64;
        if opcode != op::MESSAGE {
            if let Err(error) = self.registry.define(opcode, content) {
                self.note(offset, length, DamageKind::BadRecord { reason: error.to_string() });
            }
            return None;
        }
        let Some(header) = MessageHeader::parse(content) else {
            let reason = format!("{length} bytes are no message");
            self.note(offset, length, DamageKind::BadRecord { reason });
            return None;
        };
        let Some(topic) = self.registry.topic(header.channel) else {
            if self.unknown_topic.messages == 0 {
                self.unknown_topic.first_offset = offset;
            }
            self.unknown_topic.messages += 1;
            self.unknown_topic.bytes += length;
            return None;
        };
        Some(RawMessage {
            topic: Arc::clone(topic),
            sequence: header.sequence,
            log_time: header.log_time,
            publish_time: header.publish_time,
            data: records.slice(range.start + MessageHeader::LENGTH..range.end),
        })
    }

    fn next_outside_chunks(&mut self) -> Result<Option<RawMessage>, Error> {
        let offset = self.file.position();
        let Some(head) = self.file.record_head()? else {
            let left = self.file.remaining();
            let kind = if left == 0 { DamageKind::NotClosed } else { DamageKind::CutOff { recovered_messages: 0 } };
            self.note(offset, left, kind);
            self.finish();
            return Ok(None);
        };
        let private = head.opcode >= 0x80;
        let known = (op::HEADER..=op::DATA_END).contains(&head.opcode);
        if !known && !private {
            self.resynchronise(head)?;
            return Ok(None);
        }
        if head.length > self.file.remaining() {
            // A summary at the end means that nothing was cut off, so the length is wrong.
            if self.summary.is_some() {
                self.resynchronise(head)?
            } else {
                self.cut_off(head)?
            }
            return Ok(None);
        }
        let is_used = matches!(head.opcode, op::MESSAGE | op::SCHEMA | op::CHANNEL | op::CHUNK);
        if is_used && let Err(error) = Limit::Message.check(head.length, self.limits.message) {
            self.note(head.offset, HEADER_LENGTH + head.length, DamageKind::BadRecord { reason: error.to_string() });
            self.file.skip(head.length)?;
            return Ok(None);
        }
        match head.opcode {
            op::DATA_END | op::FOOTER => {
                if !self.closed {
                    // We lose nothing, but other readers reject such a file.
                    self.note(head.offset, 0, DamageKind::NotClosed);
                }
                self.finish();
            }
            op::MESSAGE | op::SCHEMA | op::CHANNEL => {
                let content = Bytes::from(self.file.read(head.length)?);
                return Ok(self.in_memory_record(head.opcode, &content, 0..content.len(), head.offset));
            }
            op::CHUNK => match self.unpacked(head)? {
                Ok(records) => {
                    self.unpacked = self.unpacked.saturating_add(records.len() as u64);
                    if let Err(error) = self.limits.check_unpacked(self.unpacked, self.file.length()) {
                        let left = self.file.length().saturating_sub(head.offset);
                        self.note(head.offset, left, DamageKind::UnpacksWithoutEnd { reason: error.to_string() });
                        self.finish();
                        return Ok(None);
                    }
                    self.chunk = Some(OpenChunk { offset: head.offset, records, position: 0, cut: None, recovered: 0 });
                }
                Err(fault) => {
                    let kind = DamageKind::BadChunk { reason: fault.to_string() };
                    self.note(head.offset, HEADER_LENGTH + head.length, kind);
                }
            },
            _ => self.file.skip(head.length)?,
        }
        Ok(None)
    }

    /// The records of the chunk with this head, whose content comes next in the file.
    fn unpacked(&mut self, head: RecordHead) -> Result<Result<Bytes, ChunkFault>, Error> {
        let (summary, opened, limits) = (&self.summary, &self.opened, self.limits);
        let ahead = self.ahead.get_or_insert_with(|| {
            let offsets = &summary.as_ref()?.chunk_offsets;
            let first = offsets.partition_point(|&offset| offset < head.offset);
            Ahead::start(opened, offsets.get(first..)?.to_vec(), limits)
        });
        if let Some(records) = ahead.as_mut().and_then(|ahead| ahead.take(head)) {
            self.file.skip(head.length)?;
            return Ok(records);
        }
        let record = Bytes::from(self.file.read(head.length)?);
        Ok(chunk::decompress(record, self.limits.message))
    }

    /// The file ends inside the record: recovers what it can from a cut chunk, and ends.
    fn cut_off(&mut self, head: RecordHead) -> Result<(), Error> {
        let available = self.file.remaining();
        // A length that no file can have was never set, so the missing amount is unknown.
        let missing = if head.length > i64::MAX as u64 { 0 } else { head.length - available };
        let kind = DamageKind::CutOff { recovered_messages: 0 };
        if head.opcode == op::CHUNK {
            let records =
                chunk::salvage(Bytes::from(self.file.read(available.min(self.limits.message))?), self.limits.message);
            if !records.is_empty() {
                let cut = self.damage_at(head.offset, missing, kind);
                self.chunk =
                    Some(OpenChunk { offset: head.offset, records, position: 0, cut: Some(cut), recovered: 0 });
                return Ok(());
            }
        }
        self.note(head.offset, HEADER_LENGTH + available + missing, kind);
        self.finish();
        Ok(())
    }

    /// The record is invalid: continues at the next chunk in the index, or ends.
    fn resynchronise(&mut self, head: RecordHead) -> Result<(), Error> {
        let (next, end) = match &self.summary {
            Some(summary) => {
                let next = summary.chunk_offsets.partition_point(|&offset| offset <= head.offset);
                (summary.chunk_offsets.get(next).copied().filter(|&next| next < summary.start), summary.start)
            }
            None => (None, self.file.length()),
        };
        self.note(head.offset, next.unwrap_or(end).saturating_sub(head.offset), DamageKind::LostSync);
        match next {
            Some(next) => self.file.go_to(next)?,
            None => self.finish(),
        }
        Ok(())
    }

    fn finish(&mut self) {
        let UnknownTopic { messages, bytes, first_offset } = std::mem::take(&mut self.unknown_topic);
        if messages > 0 {
            self.note(first_offset, bytes, DamageKind::UnknownTopic { messages });
        }
        self.finished = true;
    }

    fn note(&mut self, offset: u64, lost_bytes: u64, kind: DamageKind) {
        let damage = self.damage_at(offset, lost_bytes, kind);
        self.damage.push(damage);
    }

    fn damage_at(&self, offset: u64, lost_bytes: u64, kind: DamageKind) -> Damage {
        Damage { file: self.file.path().to_path_buf(), offset, lost_bytes, readable_until: self.last_log_time, kind }
    }
}
