//! Reads compressed text tables.

use std::io::{Cursor, Read};

use flate2::read::MultiGzDecoder;
use rosbag2::ReadLimits;

use super::fault::TableFault;
use super::{Table, TableFormat, text};

/// Decompresses a text and reads its table.
pub(super) fn parse(bytes: &[u8], format: &TableFormat, limits: &ReadLimits) -> Result<Table, TableFault> {
    let size = bytes.len() as u64;
    let mut text = Vec::new();
    let most = limits.memory_of(size).saturating_add(1);
    let damage = MultiGzDecoder::new(bytes).take(most).read_to_end(&mut text).err();
    let length = text.len() as u64;
    limits.check_memory(length, size)?;
    if let Some(damage) = damage.as_ref().filter(|_| text.is_empty()) {
        return Err(format!("it is no compressed text: {damage}").into());
    }
    if damage.is_some() {
        // The last line is not whole.
        text.truncate(text.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
    }
    let length = text.len() as u64;
    let mut table = text::parse(&mut Cursor::new(text), length, format, limits)?;
    table.notes.extend(damage.map(|damage| format!("the compressed file is cut off or damaged: {damage}")));
    Ok(table)
}
