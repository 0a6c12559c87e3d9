//! A read position in the bytes of a message. Allocates nothing, and rejects lengths that exceed the bytes.

use super::defined_member::Count;
use super::layout::{Kind, Layout, Primitive};
use crate::cdr::CdrError;

/// Bytes after the encapsulation, from which alignment counts, and the number read so far.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cursor<'b> {
    bytes: &'b [u8],
    position: usize,
    big_endian: bool,
}

impl<'b> Cursor<'b> {
    /// The start of a message with encapsulation.
    pub fn new(message: &'b [u8]) -> Result<Cursor<'b>, CdrError> {
        let Some((&[high, low, _, _], bytes)) = message.split_first_chunk::<4>() else {
            return Err(CdrError::NoEncapsulation(message.len()));
        };
        match u16::from_be_bytes([high, low]) {
            0 => Ok(Cursor { bytes, position: 0, big_endian: true }),
            1 => Ok(Cursor { bytes, position: 0, big_endian: false }),
            other => Err(CdrError::OtherEncapsulation(other)),
        }
    }

    /// Bytes from here to the end.
    pub fn remaining(&self) -> usize {
        self.bytes.len().saturating_sub(self.position)
    }

    fn malformed(&self, reason: String) -> CdrError {
        CdrError::Malformed { bytes: self.bytes.len(), reason: format!("{reason} at byte {}", self.position) }
    }

    fn take(&mut self, count: usize) -> Result<&'b [u8], CdrError> {
        let taken = self.bytes.get(self.position..).and_then(|rest| rest.get(..count));
        let taken = taken.ok_or_else(|| self.malformed(format!("{count} bytes are missing")))?;
        self.position += count;
        Ok(taken)
    }

    fn align(&mut self, size: usize) {
        self.position = self.position.next_multiple_of(size);
    }

    fn fixed<const N: usize>(&mut self) -> Result<[u8; N], CdrError> {
        self.align(N);
        let mut value = [0; N];
        value.copy_from_slice(self.take(N)?);
        if self.big_endian {
            value.reverse();
        }
        Ok(value)
    }

    pub fn u32(&mut self) -> Result<u32, CdrError> {
        self.fixed().map(u32::from_le_bytes)
    }

    pub fn i32(&mut self) -> Result<i32, CdrError> {
        self.fixed().map(i32::from_le_bytes)
    }

    /// A number of any type; 64-bit integers are rounded to `f64`.
    pub fn number(&mut self, primitive: Primitive) -> Result<f64, CdrError> {
        Ok(match primitive {
            Primitive::Bool | Primitive::U8 => f64::from(u8::from_le_bytes(self.fixed()?)),
            Primitive::I8 => f64::from(i8::from_le_bytes(self.fixed()?)),
            Primitive::I16 => f64::from(i16::from_le_bytes(self.fixed()?)),
            Primitive::U16 => f64::from(u16::from_le_bytes(self.fixed()?)),
            Primitive::I32 => f64::from(self.i32()?),
            Primitive::U32 => f64::from(self.u32()?),
            Primitive::I64 => i64::from_le_bytes(self.fixed()?) as f64,
            Primitive::U64 => u64::from_le_bytes(self.fixed()?) as f64,
            Primitive::F32 => f64::from(f32::from_le_bytes(self.fixed()?)),
            Primitive::F64 => f64::from_le_bytes(self.fixed()?),
        })
    }

    /// Text without its terminating zero.
    pub fn text(&mut self) -> Result<&'b [u8], CdrError> {
        let length = self.u32()? as usize;
        let bytes = self.take(length)?;
        // Some writers omit the zero of an empty text.
        Ok(bytes.strip_suffix(&[0]).unwrap_or(bytes))
    }

    /// The next `count` bytes.
    pub fn octets(&mut self, count: usize) -> Result<&'b [u8], CdrError> {
        self.take(count)
    }

    /// The number of elements; for a sequence, reads its length.
    pub fn count(&mut self, count: Count) -> Result<usize, CdrError> {
        match count {
            Count::One => Ok(1),
            Count::Fixed(length) => Ok(length),
            Count::Sequence => {
                let length = self.u32()? as usize;
                // An element takes at least one byte, so a longer sequence is impossible.
                if length > self.remaining() {
                    return Err(self.malformed(format!("a sequence of {length} elements does not fit")));
                }
                Ok(length)
            }
        }
    }

    /// Skips `count` elements.
    pub fn skip(&mut self, layout: &Layout, kind: &Kind, count: usize) -> Result<(), CdrError> {
        match kind {
            _ if count == 0 => Ok(()),
            Kind::Primitive(primitive) => {
                self.align(primitive.size());
                let bytes = count.saturating_mul(primitive.size());
                self.take(bytes).map(|_| ())
            }
            Kind::Text => (0..count).try_for_each(|_| self.text().map(|_| ())),
            Kind::Struct(number) => (0..count).try_for_each(|_| self.skip_struct(layout, *number)),
            Kind::Unreadable(name) => Err(self.malformed(format!("a {name} cannot be read"))),
        }
    }

    /// Skips one struct.
    pub fn skip_struct(&mut self, layout: &Layout, number: usize) -> Result<(), CdrError> {
        let members = layout.structure(number).map_or(&[][..], |structure| &structure.members);
        if members.is_empty() {
            // The ROS 2 generators give a message without fields one byte.
            return self.take(1).map(|_| ());
        }
        self.skip_members(layout, number, members.len())
    }

    /// Skips the first `count` members of a struct.
    pub fn skip_members(&mut self, layout: &Layout, number: usize, count: usize) -> Result<(), CdrError> {
        let members = layout.structure(number).map_or(&[][..], |structure| &structure.members);
        for member in members.iter().take(count) {
            let elements = self.count(member.count)?;
            self.skip(layout, &member.kind, elements)?;
        }
        Ok(())
    }
}
