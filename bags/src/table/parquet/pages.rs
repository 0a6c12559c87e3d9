//! Checks the announced sizes of the pages of a column before decompression.
//!
//! The library reserves as much memory as a page header requests. This module reads the headers first, up to that
//! number, in the compact protocol of Apache Thrift.

use parquet::file::metadata::ColumnChunkMetaData;
use rosbag2::ReadLimits;

/// Maximum nesting of structs in a header.
const DEPTH_LIMIT: usize = 8;

/// Decompressed bytes of the pages of the file: those of this column added to those `before`.
pub(super) fn check(
    file: &[u8],
    column: &ColumnChunkMetaData,
    before: u64,
    limits: &ReadLimits,
) -> Result<u64, String> {
    let (start, length) =
        (column.dictionary_page_offset().unwrap_or(column.data_page_offset()), column.compressed_size());
    let mut rest = usize::try_from(start)
        .ok()
        .and_then(|start| file.get(start..))
        .and_then(|rest| rest.get(..usize::try_from(length).ok()?))
        .ok_or_else(|| format!("{length} bytes from byte {start} are not in the file; it is cut or broken"))?;
    let size = file.len() as u64;
    let mut unpacked = before;
    while !rest.is_empty() {
        let at = file.len() - rest.len();
        let (header, after) = Header::read(rest).ok_or("a page without a readable header; the file is broken")?;
        unpacked = unpacked.saturating_add(header.unpacked);
        // Pages are decompressed one at a time, but each is held in memory as a whole.
        limits
            .check_memory(header.unpacked, size)
            .and_then(|()| limits.check_unpacked(unpacked, size))
            .map_err(|error| error.to_string())?;
        rest = after.get(header.packed..).ok_or_else(|| format!("the page at byte {at} is cut off"))?;
    }
    Ok(unpacked)
}

/// The sizes in a page header.
struct Header {
    unpacked: u64,
    packed: usize,
}

impl Header {
    /// The header at the start of the bytes, and the remaining bytes.
    fn read(bytes: &[u8]) -> Option<(Header, &[u8])> {
        let mut reader = Compact { rest: bytes };
        let (mut unpacked, mut packed, mut id) = (None, None, 0);
        while let Some((field, kind)) = reader.field(&mut id)? {
            match (field, kind) {
                (2, I32) => unpacked = u64::try_from(reader.whole()?).ok(),
                (3, I32) => packed = usize::try_from(reader.whole()?).ok(),
                _ => reader.skip(kind, DEPTH_LIMIT)?,
            }
        }
        Some((Header { unpacked: unpacked?, packed: packed? }, reader.rest))
    }
}

const I32: u8 = 5;

/// The compact protocol, as far as needed to skip fields.
struct Compact<'b> {
    rest: &'b [u8],
}

impl Compact<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (&byte, rest) = self.rest.split_first()?;
        self.rest = rest;
        Some(byte)
    }

    fn variable(&mut self) -> Option<u64> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let byte = self.byte()?;
            number |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Some(number);
            }
        }
        None
    }

    /// A zigzag-encoded signed integer; the sign is in the lowest bit.
    fn whole(&mut self) -> Option<i64> {
        let number = self.variable()?;
        Some((number >> 1) as i64 ^ -((number & 1) as i64))
    }

    /// Id and type of the next field, `Some(None)` at the end of the struct; `id` is the id of the previous field.
    fn field(&mut self, id: &mut i64) -> Option<Option<(i64, u8)>> {
        let byte = self.byte()?;
        if byte & 0x0f == 0 {
            return Some(None);
        }
        *id = match byte >> 4 {
            0 => self.whole()?,
            step => id.checked_add(i64::from(step))?,
        };
        Some(Some((*id, byte & 0x0f)))
    }

    fn bytes(&mut self, count: u64) -> Option<()> {
        self.rest = self.rest.get(usize::try_from(count).ok()?..)?;
        Some(())
    }

    fn skip(&mut self, kind: u8, depth: usize) -> Option<()> {
        let depth = depth.checked_sub(1)?;
        match kind {
            // The type of a boolean field is its value.
            1 | 2 => Some(()),
            3 => self.bytes(1),
            4..=6 => self.variable().map(|_| ()),
            7 => self.bytes(8),
            8 => {
                let length = self.variable()?;
                self.bytes(length)
            }
            9 | 10 => {
                let byte = self.byte()?;
                let count = if byte >> 4 == 15 { self.variable()? } else { u64::from(byte >> 4) };
                let element = byte & 0x0f;
                // In a list, a boolean takes one byte.
                (0..count).try_for_each(|_| if element <= 2 { self.bytes(1) } else { self.skip(element, depth) })
            }
            12 => {
                let mut id = 0;
                while let Some((_, kind)) = self.field(&mut id)? {
                    self.skip(kind, depth)?;
                }
                Some(())
            }
            // No header contains maps.
            _ => None,
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::Header;

    #[test]
    fn sizes_are_read_past_everything_else() {
        // Type 0, 300 decompressed, 20 compressed, a struct with an integer, a text, a list of two booleans, a boolean,
        // a number.
        let fields = [0x15, 0x00, 0x15, 0xd8, 0x04, 0x15, 0x28, 0x2c, 0x15, 0x02, 0x18, 0x02, b'h', b'i'];
        let more = [0x19, 0x21, 0x01, 0x00, 0x11, 0x17, 0, 0, 0, 0, 0, 0, 0, 0, 0x00, 0x00, b'x'];
        let bytes = [&fields[..], &more[..]].concat();
        let (header, rest) = Header::read(&bytes).unwrap();
        assert_eq!((header.unpacked, header.packed, rest), (300, 20, &b"x"[..]));
        for cut in 0..bytes.len() - 1 {
            assert!(Header::read(&bytes[..cut]).is_none(), "cut to {cut} bytes");
        }
        // A negative size, and a struct without end.
        assert!(Header::read(&[0x25, 0x01, 0x15, 0x28, 0x00]).is_none());
        assert!(Header::read(&[0x1c; 1000]).is_none());
    }
}
