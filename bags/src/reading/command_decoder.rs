//! Decodes commands; numbers are read in place if a message has the same shape as the previous one.

use std::ops::Range;

use excavator_msgs::OrificeCommand;
use rosbag2::cdr::{self, CdrError};

use super::content::Content;
use super::same_shape::{Numbers, Shape};

/// The shape of the last command.
#[derive(Debug, Default)]
pub(super) struct CommandDecoder {
    shape: Shape,
}

impl CommandDecoder {
    /// The areas of a command with the same shape as the last decoded one; `None` for any other.
    pub fn numbers<'m>(&'m self, bytes: &'m [u8]) -> Option<Numbers<'m>> {
        self.shape.numbers(bytes)
    }

    /// Decodes a command.
    pub fn decode(&mut self, bytes: &[u8]) -> Result<OrificeCommand, CdrError> {
        self.shape.forget();
        let command = cdr::decode(bytes)?;
        if let Some(areas) = areas(bytes) {
            self.shape.learn(bytes, &[areas]);
        }
        Ok(command)
    }
}

/// The position of the areas in a command, bytes from the start of the message; `None` for bytes that are not a
/// command.
fn areas(bytes: &[u8]) -> Option<Range<usize>> {
    let mut content = Content::of(bytes)?;
    let _stamp: [[u8; 4]; 2] = [content.aligned::<4>()?, content.aligned::<4>()?];
    let _frame = content.text()?;
    for _ in 0..content.u32()? {
        content.text()?;
    }
    let count = content.u32()?;
    let from = content.next_f64_at();
    for _ in 0..count {
        content.f64()?;
    }
    (count > 0 && content.is_at_end()).then_some(from..content.next_f64_at())
}

#[cfg(test)]
#[allow(clippy::expect_used)]
mod tests {
    use super::*;
    use excavator_msgs::{Header, Time};

    fn command(names: &[&str], areas: &[f64]) -> OrificeCommand {
        OrificeCommand {
            header: Header { stamp: Time { sec: 7, nanosec: 8 }, frame_id: "operator".into() },
            names: names.iter().map(ToString::to_string).collect(),
            areas: areas.to_vec(),
        }
    }

    #[test]
    fn areas_of_a_command_with_the_same_names_are_read_in_place() -> Result<(), CdrError> {
        let mut decoder = CommandDecoder::default();
        let first = command(&["boom", "löffel"], &[1.0, 2.0]);
        assert_eq!(decoder.decode(&cdr::encode(&first)?)?, first);
        let next = cdr::encode(&command(&["boom", "löffel"], &[-3.0, f64::INFINITY]))?;
        let numbers = decoder.numbers(&next).expect("the same names");
        assert_eq!((numbers.stamp(), numbers.values().collect()), (7_000_000_008, vec![-3.0, f64::INFINITY]));
        for other in [command(&["boom", "arm"], &[1.0, 2.0]), command(&["boom"], &[1.0]), command(&[], &[])] {
            assert!(decoder.numbers(&cdr::encode(&other)?).is_none(), "{other:?}");
        }
        Ok(())
    }

    #[test]
    fn a_command_without_areas_or_cut_short_is_of_no_shape() -> Result<(), CdrError> {
        let mut decoder = CommandDecoder::default();
        let empty = cdr::encode(&command(&[], &[]))?;
        decoder.decode(&empty)?;
        assert!(decoder.numbers(&empty).is_none());
        let good = cdr::encode(&command(&["arm"], &[1.0]))?;
        decoder.decode(&good)?;
        for length in 0..good.len() {
            assert!(decoder.numbers(&good[..length]).is_none(), "{length} bytes");
            let mut other = CommandDecoder::default();
            if other.decode(&good[..length]).is_err() {
                assert!(other.numbers(&good[..length]).is_none(), "{length} bytes are a shape, but no command");
            }
        }
        Ok(())
    }
}
