//! Writes chunks of one file to another file with fewer topics.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::io::BufWriter;
use std::path::Path;

use mcap::records::{ChunkHeader, Record};
use mcap::{McapError, McapResult, WriteOptions, Writer};

use super::index::Index;
use super::lengths;

/// A local file for the wanted messages.
pub(super) struct ThinFile {
    writer: Writer<BufWriter<std::fs::File>>,
    channels: BTreeSet<u16>,
    messages: u64,
}

impl ThinFile {
    /// Creates a file with the wanted channels of another, under the same numbers.
    pub(super) fn create(target: &Path, index: &Index, channels: &BTreeSet<u16>) -> McapResult<Self> {
        let file = BufWriter::new(std::fs::File::create(target)?);
        // Not compressed, since the file is temporary.
        let mut writer = WriteOptions::new().profile(index.profile.clone()).compression(None).create(file)?;
        for (id, channel) in index.summary.channels.iter().filter(|(id, _)| channels.contains(id)) {
            let mut schema_id = 0;
            if let Some(schema) = &channel.schema {
                schema_id = writer.add_schema_with_id(schema.id, &schema.name, &schema.encoding, &schema.data)?;
            }
            writer.add_channel_with_id(*id, schema_id, &channel.topic, &channel.message_encoding, &channel.metadata)?;
        }
        for one in &index.metadata {
            writer.write_metadata(one)?;
        }
        Ok(ThinFile { writer, channels: channels.clone(), messages: 0 })
    }

    /// Adds the wanted messages of the chunk in this record.
    pub(super) fn add(&mut self, record: &[u8]) -> McapResult<()> {
        let (header, packed) = chunk(record)?;
        for one in mcap::read::ChunkReader::new(header, packed)? {
            if let Record::Message { header, data } = one?
                && self.channels.contains(&header.channel_id)
            {
                self.writer.write_to_known_channel(&header, &data)?;
                self.messages += 1;
            }
        }
        Ok(())
    }

    /// Finishes the file.
    pub(super) fn finish(mut self) -> McapResult<u64> {
        self.writer.finish()?;
        Ok(self.messages)
    }
}

/// Header and compressed bytes of a chunk.
fn chunk(record: &[u8]) -> McapResult<(ChunkHeader, &[u8])> {
    let (op, body) = lengths::record(record).ok_or(McapError::UnexpectedEof)?;
    match mcap::parse_record(op, body)? {
        Record::Chunk { header, data: Cow::Borrowed(packed) } => Ok((header, packed)),
        _ => Err(McapError::BadIndex),
    }
}
