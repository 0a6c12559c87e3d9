//! State messages decoded without a single allocation.
//!
//! A recording is almost only state messages. Through serde each costs a `String` per cylinder and a `Vec`, together as
//! much as decompressing it; here one [`ArmState`] is filled again and again. Whatever this decoder does not take goes
//! through [`cdr::decode`], which knows every error by name; a test holds the two together.

use excavator_msgs::{ArmState, CylinderState, Header};

use crate::cdr::{self, CdrError};

/// Encapsulation of plain little-endian CDR; options in the last two bytes.
const LITTLE_ENDIAN: [u8; 2] = [0x00, 0x01];
/// As in [`cdr::decode`]: what is left over must be padding.
const PADDING_LIMIT: usize = 7;

/// The last decoded message.
#[derive(Debug)]
pub(super) struct StateDecoder {
    state: ArmState,
}

impl StateDecoder {
    pub fn new() -> Self {
        StateDecoder {
            state: ArmState {
                header: Header::default(),
                cylinders: Vec::new(),
                pump_pressure: f64::NAN,
                tank_pressure: f64::NAN,
                pump_flow: f64::NAN,
                oil_temperature: f64::NAN,
            },
        }
    }

    /// The message that the bytes stand for.
    pub fn decode(&mut self, bytes: &[u8]) -> Result<&ArmState, CdrError> {
        if self.fill(bytes).is_none() {
            self.state = cdr::decode(bytes)?;
        }
        Ok(&self.state)
    }

    fn fill(&mut self, bytes: &[u8]) -> Option<()> {
        let (encapsulation, content) = bytes.split_at_checked(4)?;
        if !encapsulation.starts_with(&LITTLE_ENDIAN) {
            return None;
        }
        let mut content = Content { bytes: content, position: 0 };
        let state = &mut self.state;
        state.header.stamp.sec = content.aligned::<4>().map(i32::from_le_bytes)?;
        state.header.stamp.nanosec = content.u32()?;
        content.text_into(&mut state.header.frame_id)?;
        let cylinders = usize::try_from(content.u32()?).ok()?;
        state.cylinders.truncate(cylinders);
        for index in 0..cylinders {
            if index == state.cylinders.len() {
                state.cylinders.push(CylinderState::unmeasured(""));
            }
            let cylinder = &mut state.cylinders[index];
            content.text_into(&mut cylinder.name)?;
            cylinder.joint_angle = content.f64()?;
            cylinder.displacement = content.f64()?;
            cylinder.velocity = content.f64()?;
            cylinder.cap_pressure = content.f64()?;
            cylinder.rod_pressure = content.f64()?;
            cylinder.orifice_area = content.f64()?;
            cylinder.rod_force = content.f64()?;
        }
        state.pump_pressure = content.f64()?;
        state.tank_pressure = content.f64()?;
        state.pump_flow = content.f64()?;
        state.oil_temperature = content.f64()?;
        (content.bytes.len() - content.position <= PADDING_LIMIT).then_some(())
    }
}

/// The bytes after the encapsulation, from which alignment counts, and how many of them have been read.
struct Content<'b> {
    bytes: &'b [u8],
    position: usize,
}

impl<'b> Content<'b> {
    fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let taken = self.bytes.get(self.position..)?.get(..count)?;
        self.position += count;
        Some(taken)
    }

    /// The next `N` bytes, which begin at a multiple of `N`.
    fn aligned<const N: usize>(&mut self) -> Option<[u8; N]> {
        self.position = self.position.next_multiple_of(N);
        self.take(N)?.try_into().ok()
    }

    fn u32(&mut self) -> Option<u32> {
        self.aligned::<4>().map(u32::from_le_bytes)
    }

    fn f64(&mut self) -> Option<f64> {
        self.aligned::<8>().map(f64::from_le_bytes)
    }

    /// Text with its length, which counts the closing zero, in front.
    fn text_into(&mut self, target: &mut String) -> Option<()> {
        let length = usize::try_from(self.u32()?).ok()?;
        let (_zero, text) = self.take(length)?.split_last()?;
        // Almost always it is the same name as in the message before.
        if target.as_bytes() != text {
            target.clear();
            target.push_str(std::str::from_utf8(text).ok()?);
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use excavator_msgs::Time;

    fn message(names: &[&str], seed: f64) -> ArmState {
        let cylinder = |name: &&str| CylinderState {
            name: name.to_string(),
            joint_angle: seed,
            displacement: seed + 1.0,
            velocity: seed + 2.0,
            cap_pressure: seed + 3.0,
            rod_pressure: seed + 4.0,
            orifice_area: seed + 5.0,
            rod_force: seed + 6.0,
        };
        ArmState {
            header: Header { stamp: Time { sec: -5, nanosec: seed as u32 }, frame_id: "x".repeat(names.len()) },
            cylinders: names.iter().map(cylinder).collect(),
            pump_pressure: seed + 7.0,
            tank_pressure: seed + 8.0,
            pump_flow: seed + 9.0,
            oil_temperature: seed + 10.0,
        }
    }

    #[test]
    fn it_takes_every_message_of_our_own_and_forgets_the_one_before() -> Result<(), CdrError> {
        let mut decoder = StateDecoder::new();
        let cases: [&[&str]; 6] = [&["arm"], &["boom", "arm", "bucket"], &[], &["löffel"], &["a", ""], &["arm"]];
        for (number, names) in cases.into_iter().enumerate() {
            let expected = message(names, number as f64 * 100.0);
            let bytes = cdr::encode(&expected)?;
            assert!(decoder.fill(&bytes).is_some(), "{names:?} went the slow way");
            assert_eq!(decoder.state, expected);
            assert_eq!(cdr::decode::<ArmState>(&bytes)?, expected);
        }
        Ok(())
    }

    #[test]
    fn what_it_does_not_take_fails_or_succeeds_as_with_serde() -> Result<(), CdrError> {
        let good = cdr::encode(&message(&["boom", "arm"], 3.0))?;
        let mut decoder = StateDecoder::new();
        for length in 0..good.len() {
            let expected = cdr::decode::<ArmState>(&good[..length]);
            assert_eq!(decoder.decode(&good[..length]).cloned(), expected, "{length} bytes");
        }
        for position in 0..good.len() {
            let mut bytes = good.clone();
            bytes[position] ^= 0x81;
            let expected = cdr::decode::<ArmState>(&bytes);
            assert_eq!(format!("{:?}", decoder.decode(&bytes)), format!("{:?}", expected.as_ref()), "byte {position}");
        }
        Ok(())
    }
}
