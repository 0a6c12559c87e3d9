//! Reads CAN frames from the messages of a topic: `can_msgs/msg/Frame`, and others with the same fields.

use rosbag2::cdr::CdrError;
use rosbag2::dynamic::{Layout, PathError, Selector};

use super::Identifier;

/// Masks for identifiers of 11 and of 29 bits: some drivers store flags in the bits above.
const STANDARD: u32 = 0x7ff;
const EXTENDED: u32 = 0x1fff_ffff;

/// A data frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct DataFrame<'b> {
    pub identifier: Identifier,
    pub data: &'b [u8],
}

/// The fields of a frame in a message.
#[derive(Debug, Clone)]
pub(crate) struct FrameReader {
    id: Selector,
    is_extended: Selector,
    length: Selector,
    data: Selector,
    /// Flags of frames without data.
    without_data: Vec<Selector>,
}

impl FrameReader {
    /// Resolves the fields `id`, `is_extended`, `dlc` or `len`, `data`; `is_rtr` and `is_error` if they exist.
    ///
    /// # Errors
    /// [`PathError`] for a type without them: it does not carry frames.
    pub fn of(layout: &Layout) -> Result<FrameReader, PathError> {
        let number = |name: &str| Selector::number(layout, &name.parse()?);
        Ok(FrameReader {
            id: number("id")?,
            is_extended: number("is_extended")?,
            length: number("dlc").or_else(|_| number("len"))?,
            data: Selector::octets(layout, "data")?,
            without_data: ["is_rtr", "is_error"].into_iter().filter_map(|name| number(name).ok()).collect(),
        })
    }

    /// The frame in a message; `None` if it has no data.
    ///
    /// # Errors
    /// [`CdrError`] for a message that does not fit its layout.
    pub fn read<'b>(&self, layout: &Layout, message: &'b [u8]) -> Result<Option<DataFrame<'b>>, CdrError> {
        let number = |selector: &Selector| selector.read(layout, message).map(|number| number.unwrap_or(0.0));
        for flag in &self.without_data {
            if number(flag)? != 0.0 {
                return Ok(None);
            }
        }
        let extended = number(&self.is_extended)? != 0.0;
        let mask = if extended { EXTENDED } else { STANDARD };
        let identifier = Identifier { number: number(&self.id)? as u32 & mask, extended };
        let data = self.data.read_octets(layout, message)?;
        let length = (number(&self.length)? as usize).min(data.len());
        Ok(Some(DataFrame { identifier, data: &data[..length] }))
    }
}
