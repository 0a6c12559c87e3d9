//! Parses records with the `mcap` crate after a check of their lengths.

use mcap::McapError;
use mcap::records::{Record, op};

use super::fields::Fields;

/// Parses a schema, a channel or a chunk index.
///
/// The crate allocates a text before it checks that the text exists: four bytes could request 4 GB.
///
/// # Errors
/// [`McapError::UnexpectedEof`] if a length exceeds the record; otherwise the errors of the crate.
pub(super) fn parsed(opcode: u8, content: &[u8]) -> Result<Record<'_>, McapError> {
    let mut fields = Fields(content);
    let fits = match opcode {
        op::SCHEMA => schema_fits(&mut fields),
        op::CHANNEL => channel_fits(&mut fields),
        op::CHUNK_INDEX => chunk_index_fits(&mut fields),
        _ => Some(()),
    };
    fits.ok_or(McapError::UnexpectedEof)?;
    mcap::parse_record(opcode, content)
}

/// Id, name, encoding, text.
fn schema_fits(fields: &mut Fields<'_>) -> Option<()> {
    fields.bytes(2)?;
    (0..3).try_for_each(|_| fields.counted().map(drop))
}

/// Two ids, topic, encoding, a map of texts.
fn channel_fits(fields: &mut Fields<'_>) -> Option<()> {
    fields.bytes(4)?;
    (0..2).try_for_each(|_| fields.counted().map(drop))?;
    let mut entries = Fields(fields.counted()?);
    while !entries.0.is_empty() {
        entries.counted()?;
    }
    Some(())
}

/// Times and offset, a map of numbers, a length, name of the compression.
fn chunk_index_fits(fields: &mut Fields<'_>) -> Option<()> {
    fields.bytes(32)?;
    fields.counted()?;
    fields.bytes(8)?;
    fields.counted().map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Vec<u8> {
        [&u32::try_from(text.len()).unwrap_or_default().to_le_bytes(), text.as_bytes()].concat()
    }

    #[test]
    fn whole_records_are_taken_and_lengths_beyond_them_are_refused() {
        let schema = [vec![1, 0], text("std_msgs/msg/String"), text("ros2msg"), text("string data")].concat();
        let entry = [text("offered_qos_profiles"), text("")].concat();
        let map = [u32::try_from(entry.len()).unwrap_or_default().to_le_bytes().to_vec(), entry].concat();
        let channel = [vec![1, 0, 1, 0], text("/chatter"), text("cdr"), map].concat();
        let index = [vec![0; 32], text(""), vec![0; 8], text("zstd"), vec![0; 16]].concat();
        for (opcode, content, lengths) in [
            (op::SCHEMA, schema, vec![2, 25, 36]),
            (op::CHANNEL, channel, vec![4, 16, 23, 27, 51]),
            (op::CHUNK_INDEX, index, vec![32, 44]),
        ] {
            assert!(parsed(opcode, &content).is_ok(), "{opcode}");
            for length in lengths {
                let mut broken = content.clone();
                broken[length..length + 4].copy_from_slice(&0x9000_0000_u32.to_le_bytes());
                assert!(matches!(parsed(opcode, &broken), Err(McapError::UnexpectedEof)), "{opcode} at {length}");
            }
        }
    }
}
