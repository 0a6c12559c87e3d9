//! Extracts a number from the bits of a frame.

/// The position and coding of the bits of a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bits {
    /// First bit in DBC numbering: the least significant bit of a little endian number, the most significant bit of a
    /// big endian one; bit 0 is the least significant of byte 0.
    pub start: usize,
    /// Number of bits, 1 to 64.
    pub length: usize,
    /// Whether the most significant bits come first.
    pub big_endian: bool,
    /// Coding of the bits.
    pub coding: Coding,
}

/// Coding of bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub(super) enum Coding {
    Unsigned,
    /// Two's complement.
    Signed,
    /// IEEE 754, 32 bits.
    Float32,
    /// IEEE 754, 64 bits.
    Float64,
}

impl Bits {
    /// Minimum length of a frame that contains the number, bytes.
    pub fn bytes(&self) -> usize {
        if !self.big_endian {
            return (self.start + self.length).div_ceil(8);
        }
        // From the first bit down to bit 0 of its byte, then whole bytes downwards.
        let in_first = self.start % 8 + 1;
        self.start / 8 + 1 + self.length.saturating_sub(in_first).div_ceil(8)
    }

    /// The bits as an unsigned number; `None` if the frame is too short.
    pub fn raw(&self, data: &[u8]) -> Option<u64> {
        if data.len() < self.bytes() {
            return None;
        }
        let mut position = self.start;
        let mut raw = 0_u64;
        for index in 0..self.length {
            let bit = u64::from(data.get(position / 8)? >> (position % 8) & 1);
            if self.big_endian {
                raw = raw << 1 | bit;
                // Bit 0 of a byte is followed by bit 7 of the next.
                position = if position.is_multiple_of(8) { position + 15 } else { position - 1 };
            } else {
                raw |= bit << index;
                position += 1;
            }
        }
        Some(raw)
    }

    /// The number before factor and offset; `None` if the frame is too short.
    pub fn number(&self, data: &[u8]) -> Option<f64> {
        let raw = self.raw(data)?;
        Some(match self.coding {
            Coding::Unsigned => raw as f64,
            Coding::Signed => {
                let unused = 64 - self.length;
                ((raw << unused) as i64 >> unused) as f64
            }
            Coding::Float32 => f64::from(f32::from_bits(u32::try_from(raw).ok()?)),
            Coding::Float64 => f64::from_bits(raw),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bits(start: usize, length: usize, big_endian: bool, coding: Coding) -> Bits {
        Bits { start, length, big_endian, coding }
    }

    #[test]
    fn little_endian_numbers_cross_bytes() {
        let twelve = bits(4, 12, false, Coding::Unsigned);
        assert_eq!((twelve.bytes(), twelve.raw(&[0xa0, 0xbc])), (2, Some(0xbca)));
        assert_eq!(twelve.raw(&[0xa0]), None);
    }

    #[test]
    fn big_endian_numbers_start_with_their_most_significant_bit() {
        let sixteen = bits(7, 16, true, Coding::Unsigned);
        assert_eq!((sixteen.bytes(), sixteen.raw(&[0x12, 0x34])), (2, Some(0x1234)));
        let ten = bits(3, 10, true, Coding::Unsigned);
        assert_eq!((ten.bytes(), ten.raw(&[0xfa, 0xc7])), (2, Some(0b10_1011_0001)));
    }

    #[test]
    fn negative_and_whole_width_numbers_are_read() {
        assert_eq!(bits(0, 12, false, Coding::Signed).number(&[0xff, 0x0f]), Some(-1.0));
        assert_eq!(bits(0, 64, false, Coding::Signed).number(&[0xff; 8]), Some(-1.0));
        assert_eq!(bits(0, 32, false, Coding::Float32).number(&(-0.5_f32).to_le_bytes()), Some(-0.5));
        assert_eq!(bits(7, 64, true, Coding::Float64).number(&1e-4_f64.to_be_bytes()), Some(1e-4));
    }
}
