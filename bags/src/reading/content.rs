//! Reads the bytes of a message in plain little-endian CDR from front to back.

/// Bytes of encapsulation before the content.
pub(super) const ENCAPSULATION: usize = 4;
/// Encapsulation of plain little-endian CDR; options in the last two bytes.
const LITTLE_ENDIAN: [u8; 2] = [0x00, 0x01];
/// As in [`rosbag2::cdr::decode`]: the rest must be padding.
const PADDING_LIMIT: usize = 7;

/// The bytes after the encapsulation, from which alignment counts, and the number of bytes read so far.
///
/// Every step returns `None` if there are too few bytes.
#[derive(Debug)]
pub(super) struct Content<'b> {
    bytes: &'b [u8],
    position: usize,
}

impl<'b> Content<'b> {
    /// The content of a message; `None` for any other encapsulation.
    pub fn of(message: &'b [u8]) -> Option<Content<'b>> {
        let (encapsulation, bytes) = message.split_at_checked(ENCAPSULATION)?;
        encapsulation.starts_with(&LITTLE_ENDIAN).then_some(Content { bytes, position: 0 })
    }

    fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let taken = self.bytes.get(self.position..)?.get(..count)?;
        self.position += count;
        Some(taken)
    }

    /// The next `N` bytes, aligned to a multiple of `N`.
    pub fn aligned<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.position = self.position.next_multiple_of(N);
        self.take(N)?.try_into().ok()
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.aligned::<4>().map(u32::from_le_bytes)
    }

    pub fn f64(&mut self) -> Option<f64> {
        self.aligned::<8>().map(f64::from_le_bytes)
    }

    /// The bytes of a text, preceded by their length, which includes the terminating zero.
    pub fn text(&mut self) -> Option<&'b [u8]> {
        let length = usize::try_from(self.u32()?).ok()?;
        let (_zero, text) = self.take(length)?.split_last()?;
        Some(text)
    }

    /// Offset of the next 8-byte number, bytes from the start of the message.
    pub fn next_f64_at(&self) -> usize {
        ENCAPSULATION + self.position.next_multiple_of(size_of::<f64>())
    }

    /// Whether only padding is left.
    pub fn is_at_end(&self) -> bool {
        self.bytes.len() - self.position <= PADDING_LIMIT
    }
}
