//! Decodes state messages without allocation.
//!
//! Almost all messages of a recording are state messages. With serde each costs a `String` per cylinder and a `Vec`,
//! together as much as decompressing it. Here, numbers are read in place if the message has the same shape as the
//! previous one; other messages reuse one [`ArmState`]. Anything that this decoder rejects goes through
//! [`cdr::decode`], which returns the precise error; a test checks that both agree.

use std::ops::Range;

use excavator_msgs::{ArmState, CylinderState, Header};
use rosbag2::cdr::{self, CdrError};

use super::content::Content;
use super::same_shape::{Numbers, Shape};

/// The last message that was not read in place, and its shape.
#[derive(Debug)]
pub(super) struct StateDecoder {
    state: ArmState,
    shape: Shape,
    /// The positions of the numbers in the last message.
    runs: Vec<Range<usize>>,
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
            shape: Shape::default(),
            runs: Vec::new(),
        }
    }

    /// The numbers of a message with the same shape as the last decoded one: those of each cylinder in message order,
    /// then those of the machine. `None` for any other message.
    pub fn numbers<'m>(&'m self, bytes: &'m [u8]) -> Option<Numbers<'m>> {
        self.shape.numbers(bytes)
    }

    /// Decodes a message.
    pub fn decode(&mut self, bytes: &[u8]) -> Result<&ArmState, CdrError> {
        if self.fill(bytes).is_some() {
            self.shape.learn(bytes, &self.runs);
        } else {
            self.shape.forget();
            self.state = cdr::decode(bytes)?;
        }
        Ok(&self.state)
    }

    fn fill(&mut self, bytes: &[u8]) -> Option<()> {
        let mut content = Content::of(bytes)?;
        self.runs.clear();
        let state = &mut self.state;
        state.header.stamp.sec = content.aligned::<4>().map(i32::from_le_bytes)?;
        state.header.stamp.nanosec = content.u32()?;
        set_text(&mut state.header.frame_id, content.text()?)?;
        let cylinders = usize::try_from(content.u32()?).ok()?;
        state.cylinders.truncate(cylinders);
        for index in 0..cylinders {
            if index == state.cylinders.len() {
                state.cylinders.push(CylinderState::unmeasured(""));
            }
            let cylinder = &mut state.cylinders[index];
            set_text(&mut cylinder.name, content.text()?)?;
            let from = content.next_f64_at();
            cylinder.joint_angle = content.f64()?;
            cylinder.displacement = content.f64()?;
            cylinder.velocity = content.f64()?;
            cylinder.cap_pressure = content.f64()?;
            cylinder.rod_pressure = content.f64()?;
            cylinder.orifice_area = content.f64()?;
            cylinder.rod_force = content.f64()?;
            self.runs.push(from..content.next_f64_at());
        }
        let from = content.next_f64_at();
        state.pump_pressure = content.f64()?;
        state.tank_pressure = content.f64()?;
        state.pump_flow = content.f64()?;
        state.oil_temperature = content.f64()?;
        self.runs.push(from..content.next_f64_at());
        content.is_at_end().then_some(())
    }
}

/// `None` for bytes that are not text.
fn set_text(target: &mut String, text: &[u8]) -> Option<()> {
    // The name is almost always the same as in the previous message.
    if target.as_bytes() != text {
        target.clear();
        target.push_str(std::str::from_utf8(text).ok()?);
    }
    Some(())
}

#[cfg(test)]
#[allow(clippy::expect_used)]
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
    fn the_numbers_of_a_message_of_the_same_shape_are_those_of_the_message() -> Result<(), CdrError> {
        let mut decoder = StateDecoder::new();
        for names in [&["boom", "arm"] as &[&str], &["a", "", "löffel"], &[]] {
            let first = cdr::encode(&message(names, 1.0))?;
            decoder.decode(&first)?;
            let next = message(names, 50.0);
            let bytes = cdr::encode(&next)?;
            let numbers = decoder.numbers(&bytes).expect("the same names");
            assert_eq!(numbers.stamp(), next.header.stamp.nanoseconds());
            let cylinders = next.cylinders.iter().flat_map(|cylinder| {
                [
                    cylinder.joint_angle,
                    cylinder.displacement,
                    cylinder.velocity,
                    cylinder.cap_pressure,
                    cylinder.rod_pressure,
                    cylinder.orifice_area,
                    cylinder.rod_force,
                ]
            });
            let shared = [next.pump_pressure, next.tank_pressure, next.pump_flow, next.oil_temperature];
            let expected: Vec<f64> = cylinders.chain(shared).collect();
            assert_eq!(numbers.values().collect::<Vec<_>>(), expected);
        }
        Ok(())
    }

    #[test]
    fn a_message_that_differs_in_more_than_numbers_is_of_another_shape() -> Result<(), CdrError> {
        let mut decoder = StateDecoder::new();
        let good = cdr::encode(&message(&["boom", "arm"], 3.0))?;
        assert!(decoder.numbers(&good).is_none(), "nothing was decoded yet");
        decoder.decode(&good)?;
        for other in [&["boom", "arm", "bucket"] as &[&str], &["boon", "arm"], &["arm", "boom"], &["boom"]] {
            assert!(decoder.numbers(&cdr::encode(&message(other, 3.0))?).is_none(), "{other:?}");
        }
        for length in 0..good.len() {
            assert!(decoder.numbers(&good[..length]).is_none(), "{length} bytes");
        }
        for position in 0..good.len() {
            let mut bytes = good.clone();
            bytes[position] ^= 0x81;
            let Some(numbers) = decoder.numbers(&bytes).map(|numbers| numbers.values().collect::<Vec<_>>()) else {
                continue;
            };
            let mut serde = StateDecoder::new();
            serde.state = cdr::decode(&bytes)?;
            let again = cdr::encode(&serde.state)?;
            serde.decode(&again)?;
            let expected: Vec<f64> = serde.numbers(&again).into_iter().flat_map(Numbers::values).collect();
            assert_eq!(numbers, expected, "byte {position}");
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
