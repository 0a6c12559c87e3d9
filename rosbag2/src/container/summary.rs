//! The index at the end of a file: used to skip damage, and as a second copy of the topic definitions.

use mcap::records::{Record, op};

use super::fields::Fields;
use super::framing::{HEADER_LENGTH, RecordFile, next_in_memory};
use super::record::parsed;
use super::registry::Registry;
use crate::Error;
use crate::limits::ReadLimits;

/// Content of a footer record, bytes.
const FOOTER_LENGTH: u64 = 20;
/// Bytes of the footer that its checksum does not cover: the checksum itself.
const CHECKSUM_LENGTH: usize = 4;

/// The parts of the summary section that are used.
#[derive(Debug, Default)]
pub(super) struct Summary {
    /// Where chunks begin, bytes from the start of the file, ascending.
    pub chunk_offsets: Vec<u64>,
    /// Where the summary begins: the end of the data, bytes from the start of the file.
    pub start: u64,
}

impl Summary {
    /// Reads the summary and adds its definitions to the registry. `None` if the file has no valid summary. The
    /// position of the file is undefined afterwards.
    pub fn read(file: &mut RecordFile, registry: &mut Registry, limits: &ReadLimits) -> Result<Option<Summary>, Error> {
        let tail_length = HEADER_LENGTH + FOOTER_LENGTH + mcap::MAGIC.len() as u64;
        let Some(footer_offset) = file.length().checked_sub(tail_length) else {
            return Ok(None);
        };
        file.go_to(footer_offset)?;
        let tail = file.read(tail_length)?;
        let Some((start, checksum)) = parse_footer(&tail) else {
            return Ok(None);
        };
        // A summary that is too large to hold is not needed: the data is read from its beginning.
        if start == 0 || start >= footer_offset || footer_offset - start > limits.message {
            return Ok(None);
        }
        file.go_to(start)?;
        let mut section = file.read(footer_offset - start)?;
        if checksum != 0 {
            let covered = (HEADER_LENGTH + FOOTER_LENGTH) as usize - CHECKSUM_LENGTH;
            let records = section.len();
            section.extend_from_slice(tail.get(..covered).unwrap_or_default());
            if crc32fast::hash(&section) != checksum {
                return Ok(None);
            }
            section.truncate(records);
        }
        Ok(Some(Summary { chunk_offsets: read_section(&section, registry), start }))
    }
}

/// Start of the summary and its checksum, if the tail of the file is a footer and the closing magic.
fn parse_footer(tail: &[u8]) -> Option<(u64, u32)> {
    let mut fields = Fields(tail);
    let is_footer = fields.u8()? == op::FOOTER && fields.u64()? == FOOTER_LENGTH;
    let start = fields.u64()?;
    let _summary_offset_start = fields.u64()?;
    let checksum = fields.u32()?;
    (is_footer && fields.0 == mcap::MAGIC).then_some((start, checksum))
}

fn read_section(section: &[u8], registry: &mut Registry) -> Vec<u64> {
    let mut chunk_offsets = Vec::new();
    let mut position = 0;
    // Invalid records here are ignored: the data itself is read in any case.
    while let Ok(Some((opcode, range))) = next_in_memory(section, &mut position) {
        let content = &section[range];
        if opcode == op::CHUNK_INDEX {
            if let Ok(Record::ChunkIndex(index)) = parsed(opcode, content) {
                chunk_offsets.push(index.chunk_start_offset);
            }
        } else if registry.define(opcode, content).is_err() {
            continue;
        }
    }
    chunk_offsets.sort_unstable();
    chunk_offsets
}
