//! Tests the program of the filter with crafted and captured packets, on the machine in [`super::interpreter`].

use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

use super::SHAPE;
use super::assembler::{Instruction, MOST_INSTRUCTIONS};
use super::interpreter::run;
use super::program::{Limits, program};

const LIMITS: Limits = Limits { heartbeat_span: 1 << 17, gap_span: 8192, sample_bytes: 1 << 20, fragments: 1 << 12 };

fn guard() -> Vec<Instruction> {
    program(&LIMITS, &SHAPE).unwrap()
}

/// Whether the program lets an RTPS message through.
fn passes(program: &[Instruction], message: &[u8]) -> bool {
    run(program, &[&[0; 8], message].concat()) != 0
}

/// An RTPS message that is built step by step.
#[derive(Clone)]
struct Message {
    bytes: Vec<u8>,
    little: bool,
}

impl Message {
    fn new(little: bool) -> Self {
        Message { bytes: [&b"RTPS\x02\x04\x01\x12"[..], &[7; 12]].concat(), little }
    }

    fn word(&self, value: u32) -> [u8; 4] {
        if self.little { value.to_le_bytes() } else { value.to_be_bytes() }
    }

    fn half(&self, value: u16) -> [u8; 2] {
        if self.little { value.to_le_bytes() } else { value.to_be_bytes() }
    }

    fn number(&self, value: i64) -> Vec<u8> {
        [self.word((value >> 32) as u32), self.word(value as u32)].concat()
    }

    fn with(mut self, kind: u8, body: &[u8]) -> Self {
        let length = self.half(u16::try_from(body.len()).unwrap());
        self.bytes.extend([kind, u8::from(self.little)]);
        self.bytes.extend(length);
        self.bytes.extend(body);
        self
    }

    fn heartbeat(self, first: i64, last: i64) -> Self {
        let body = [vec![1; 8], self.number(first), self.number(last), self.word(9).to_vec()].concat();
        self.with(0x07, &body)
    }

    fn gap(self, start: i64, base: i64) -> Self {
        let body = [vec![1; 8], self.number(start), self.number(base), self.word(0).to_vec()].concat();
        self.with(0x08, &body)
    }

    fn data(self, bytes: usize) -> Self {
        let body = [vec![0, 0, 16, 0], vec![1; 8], self.number(1 << 40), vec![7; bytes]].concat();
        self.with(0x15, &body)
    }

    fn time_stamp(self) -> Self {
        self.with(0x09, &[7; 8])
    }

    fn data_frag(self, sample: u32) -> Self {
        let [first, one, size] = [self.word(1).to_vec(), self.half(1).to_vec(), self.half(256).to_vec()];
        let body =
            [vec![0, 0, 28, 0], vec![1; 8], self.number(5), first, one, size, self.word(sample).to_vec(), vec![7; 256]];
        self.with(0x16, &body.concat())
    }

    fn nack_frag(self, first: u32) -> Self {
        let body =
            [vec![1; 8], self.number(5), self.word(first).to_vec(), self.word(0).to_vec(), self.word(3).to_vec()];
        self.with(0x12, &body.concat())
    }
}

#[test]
fn the_program_is_one_that_the_kernel_takes() {
    let length = guard().len();
    println!("{length} instructions");
    assert!(length <= MOST_INSTRUCTIONS);
}

#[test]
fn what_peers_send_passes() {
    let program = guard();
    for little in [true, false] {
        let message = || Message::new(little);
        for (name, message) in [
            ("nothing yet", message().heartbeat(1, 0)),
            ("number 0", message().heartbeat(0, 0)),
            ("fifty of a long run", message().time_stamp().data(100).heartbeat(3_599_951, 3_600_000)),
            ("60 000 unacknowledged", message().heartbeat(40_001, 100_000)),
            ("over the low word", message().heartbeat((1 << 32) - 40_000, (1 << 32) + 20_000)),
            ("nothing, at the low word", message().heartbeat(1 << 32, (1 << 32) - 1)),
            ("the limit", message().heartbeat(1 << 35, (1 << 35) + (1 << 17) - 1)),
            ("a gap of a late joiner", message().gap(1, 1 << 33)),
            ("a gap", message().gap(70_000, 78_192)),
            ("a fragment", message().data_frag((1 << 20) - 1)),
            ("a fragment asked for", message().nack_frag(4095)),
            ("to the end", {
                let mut message = message().time_stamp().data(40);
                message.bytes[20 + 12 + 2..][..2].copy_from_slice(&[0, 0]);
                message
            }),
            ("empty submessages", message().with(0x01, &[]).with(0x09, &[]).heartbeat(1, 2)),
            ("of a vendor", message().with(0x80, &[1; 20]).heartbeat(1, 2)),
        ] {
            assert!(passes(&program, &message.bytes), "{name}, little endian {little}");
        }
    }
}

#[test]
fn what_makes_the_middleware_loop_does_not_pass() {
    let program = guard();
    for little in [true, false] {
        let message = || Message::new(little).with(0x0e, &[7; 12]);
        for (name, message) in [
            ("a heartbeat beyond the limit", message().heartbeat(1, (1 << 17) + 512)),
            ("a heartbeat over the low word", message().heartbeat(1 << 31, (1 << 32) + 5)),
            ("a heartbeat of 2^32", message().heartbeat(1, (1 << 32) + 1)),
            ("a heartbeat of 2^60", message().heartbeat(1, 1 << 60)),
            ("a heartbeat far out", message().heartbeat(1 << 60, 1 << 60)),
            ("a heartbeat from below zero", message().heartbeat(-5, 3)),
            ("a heartbeat that ends before it begins", message().heartbeat(100_000, 3)),
            ("a gap beyond the limit", message().gap(300, 300 + 8192 + 512)),
            ("a gap of 2^40", message().gap(2, (1 << 40) - 1)),
            ("a gap from a number that is 1 the other way round", message().gap(1 << 24, 1 << 30)),
            ("a gap from 2^32 + 1", message().gap((1 << 32) + 1, 1 << 36)),
            ("a fragment of 4 GB", message().data_frag(u32::MAX)),
            ("a fragment of the limit", message().data_frag(1 << 20)),
            ("fragment 0 asked for", message().nack_frag(0)),
            ("fragment 4096 asked for", message().nack_frag(4096)),
            ("fragment 2^32 asked for", message().nack_frag(u32::MAX)),
        ] {
            assert!(!passes(&program, &message.bytes), "{name}, little endian {little}");
            let behind = Message { bytes: message.bytes, little }.time_stamp().data(20);
            assert!(!passes(&program, &behind.bytes), "{name} before a sample, little endian {little}");
        }
    }
}

#[test]
fn what_rustdds_packs_into_one_datagram_passes_and_hides_nothing() {
    let program = guard();
    let pairs =
        |count| (0..count).fold(Message::new(true).with(0x0e, &[7; 12]), |message, _| message.time_stamp().data(40));
    // A repair round has 8192 bytes.
    let most = pairs(8192 / (12 + 24 + 24)).heartbeat(1, 50);
    assert!(passes(&program, &most.bytes), "{} bytes", most.bytes.len());
    for count in [0, 1, 3, 5, 40, 80, 140] {
        assert!(!passes(&program, &pairs(count).heartbeat(1, 1 << 50).bytes), "behind {count} samples");
    }
    let endless = pairs(400).heartbeat(1, 1 << 50);
    assert!(!passes(&program, &endless.bytes), "beyond the walk");
}

#[test]
fn what_is_no_rtps_message_passes() {
    for bytes in [&b""[..], b"x", b"RTPX and some more bytes of something", b"RTPS"] {
        assert!(passes(&guard(), bytes));
    }
}

/// Whether a message should pass with the limits; `None` if the rule is only exact to a step of 256, or if RustDDS
/// would reject the message itself.
fn expected(message: &[u8], limits: &Limits) -> Option<bool> {
    let mut rest = message.get(20..)?;
    let mut every = true;
    while !rest.is_empty() {
        let (kind, little) = (*rest.first()?, rest.get(1)? & 1 == 1);
        let word = |place: usize| {
            let bytes: [u8; 4] = rest.get(place..place + 4)?.try_into().ok()?;
            Some(if little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) })
        };
        let number = |place: usize| Some(i64::from(word(place)? as i32) << 32 | i64::from(word(place + 4)?));
        let long = |span: i128, limit: u32| match span {
            span if span <= i128::from(limit) => Some(false),
            span if span > i128::from(limit) + 256 => Some(true),
            _ => None,
        };
        let far = |number: i64| !(0..1 << 40).contains(&number);
        let refused = match kind {
            0x07 => {
                let (first, last) = (number(12)?, number(20)?);
                let span = i128::from(last) - i128::from(first) + 1;
                // An invalid span that does not make RustDDS loop may pass or not.
                if span < 0 && !far(first) && !far(last) {
                    return None;
                }
                far(first) || far(last) || long(span, limits.heartbeat_span)?
            }
            0x08 => {
                let (start, base) = (number(12)?, number(20)?);
                let span = i128::from(base) - i128::from(start);
                if span < 0 && !far(start) && !far(base) {
                    return None;
                }
                far(start) || far(base) || (start != 1 && long(span, limits.gap_span)?)
            }
            0x16 => word(32)? >= limits.sample_bytes,
            0x12 => word(20)? == 0 || word(20)? >= limits.fragments,
            _ => false,
        };
        every &= !refused;
        let length = [*rest.get(2)?, *rest.get(3)?];
        let length = usize::from(if little { u16::from_le_bytes(length) } else { u16::from_be_bytes(length) });
        rest = match (length, kind) {
            (0, 0x01 | 0x09) => &rest[4..],
            (0, _) => &[],
            _ => rest.get(4 + length..)?,
        };
    }
    Some(every)
}

#[test]
fn program_and_reference_agree_on_mutated_messages() {
    let mut random = StdRng::seed_from_u64(28);
    let program = guard();
    let (mut passed, mut refused) = (0, 0);
    for _ in 0..200_000 {
        let little = random.random_range(0..4) > 0;
        let mut message = Message::new(little);
        for _ in 0..random.random_range(1..4) {
            let first = 1_i64 << random.random_range(0..42);
            let first = first + random.random_range(-2..300);
            let last = first + (1_i64 << random.random_range(0..40)) - random.random_range(0..2);
            message = match random.random_range(0..8) {
                0 | 1 => message.heartbeat(first, last),
                2 => message.gap(first, last),
                3 => message.gap(1, last),
                4 => message.data_frag(1 << random.random_range(0..32)),
                5 => message.nack_frag(random.random_range(0..2) << random.random_range(0..32)),
                6 => message.time_stamp(),
                _ => message.data(random.random_range(0..60)),
            };
        }
        for _ in 0..random.random_range(0..3) {
            let place = random.random_range(20..message.bytes.len());
            message.bytes[place] = random.random();
        }
        if random.random_range(0..8) == 0 {
            message.bytes.truncate(random.random_range(20..message.bytes.len()));
        }
        let Some(expected) = expected(&message.bytes, &LIMITS) else { continue };
        if expected {
            passed += 1
        } else {
            refused += 1
        }
        assert_eq!(passes(&program, &message.bytes), expected, "{:02x?}", message.bytes);
    }
    println!("{passed} passed, {refused} refused");
    assert!(passed > 30_000 && refused > 30_000, "{passed} passed, {refused} refused");
}

/// Messages of simulator, monitor and recorder on a loopback, one of each sequence of submessages, in hexadecimal digits.
fn captured() -> Vec<Vec<u8>> {
    let byte = |line: &str, at: usize| u8::from_str_radix(&line[at..at + 2], 16).unwrap();
    let line = |line: &str| (0..line.len()).step_by(2).map(|at| byte(line, at)).collect();
    include_str!("captured.hex").lines().map(line).collect()
}

#[test]
fn captured_messages_pass_and_mutated_ones_that_the_reference_refuses_do_not() {
    let program = guard();
    let mut random = StdRng::seed_from_u64(52);
    let (mut judged, mut refused) = (0, 0);
    for message in captured() {
        assert!(passes(&program, &message), "{message:02x?}");
        for _ in 0..2_000 {
            let mut message = message.clone();
            for _ in 0..random.random_range(1..6) {
                let place = random.random_range(20..message.len().min(600));
                message[place] = random.random();
            }
            let Some(expected) = expected(&message, &LIMITS) else { continue };
            judged += 1;
            if !expected {
                refused += 1;
                assert!(!passes(&program, &message), "{message:02x?}");
            }
        }
    }
    println!("{judged} judged, {refused} refused");
    assert!(judged > 10_000 && refused > 100, "{judged} judged, {refused} refused");
}
