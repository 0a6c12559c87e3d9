//! Locates signals in frames, from a DBC file.

use std::ops::RangeInclusive;
use std::path::Path;

use can_dbc::{
    ByteOrder, Dbc, Message, MessageId, MultiplexIndicator, NumericValue, Signal, SignalExtendedValueType, ValueType,
};
use rosbag2::{ReadLimits, read_regular};

use super::bits::{Bits, Coding};

/// Maximum size of a DBC file, bytes: those of whole vehicles have one or two megabytes.
const LONGEST: u64 = 16 << 20;
/// Name of the built-in file, and its text.
const COM3: &str = "com3";
const COM3_TEXT: &[u8] = include_bytes!("com3.dbc");
/// Maximum length of a chain of multiplexers, in which each selects the next.
const DEEPEST: usize = 8;
/// Maximum length of a frame (CAN FD), bytes.
const LONGEST_FRAME: usize = 64;

/// Identifier of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Identifier {
    /// 11 bits, or 29 of an extended one.
    pub number: u32,
    /// Whether it is an extended identifier.
    pub extended: bool,
}

impl Identifier {
    /// Bits of 29 that name a message in J1939 and its relatives: its parameter group number. Priority and source address are not
    /// among them, nor is the destination of a message that has one.
    fn group_mask(self) -> u32 {
        const FIRST_BROADCAST: u32 = 0xf0;
        if self.number >> 16 & 0xff < FIRST_BROADCAST { 0x03ff_0000 } else { 0x03ff_ff00 }
    }

    /// Source address of a frame with 29 bits.
    pub fn source(self) -> Option<u8> {
        self.extended.then_some(self.number as u8)
    }
}

/// A multiplexer, and its values for which the frame carries a signal.
type Selector = (Bits, Vec<RangeInclusive<u64>>);

/// The position of a signal in its frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    identifier: Identifier,
    /// Bits of the identifier in which a frame agrees with it.
    mask: u32,
    bits: Bits,
    factor: f64,
    offset: f64,
    /// Range given by the file, in its unit.
    range: Option<(f64, f64)>,
    /// As written in the file; empty if none.
    unit: String,
    /// Ordered from the signal up to the root.
    selectors: Vec<Selector>,
}

impl Place {
    /// Identifier of the message in the file.
    pub fn identifier(&self) -> Identifier {
        self.identifier
    }

    /// Bits of [`Place::identifier`] in which a frame must agree with it. 11 bits agree as a whole, 29 bits in their parameter group
    /// number: any source address and priority, unless several messages of the file have the same number.
    pub fn mask(&self) -> u32 {
        self.mask
    }

    /// Whether a frame with this identifier may carry the signal.
    pub fn is_in(&self, frame: Identifier) -> bool {
        frame.extended == self.identifier.extended && (frame.number ^ self.identifier.number) & self.mask == 0
    }

    /// Unit in the file; empty if none.
    pub fn unit(&self) -> &str {
        &self.unit
    }

    /// Whether the frame carries the signal. A frame too short for a multiplexer carries none of its signals.
    pub fn is_selected(&self, data: &[u8]) -> bool {
        self.selectors.iter().all(|(bits, values)| {
            bits.raw(data).is_some_and(|value| values.iter().any(|allowed| allowed.contains(&value)))
        })
    }

    /// The value in the unit of the file; `None` if the frame is too short.
    pub fn value(&self, data: &[u8]) -> Option<f64> {
        self.bits.number(data).map(|number| number * self.factor + self.offset)
    }

    /// Range given by the file, in its unit, widened by half a step for rounding.
    pub fn range(&self) -> Option<(f64, f64)> {
        let slack = match self.bits.coding {
            Coding::Unsigned | Coding::Signed => 0.5 * self.factor.abs(),
            Coding::Float32 | Coding::Float64 => 0.0,
        };
        self.range.map(|(least, largest)| (least - slack, largest + slack))
    }
}

/// A DBC file.
#[derive(Debug)]
pub struct Database {
    dbc: Dbc,
}

impl Database {
    /// Reads a file; `com3`, where there is no such file, is the built-in one of excavators with the interface COM3.
    ///
    /// # Errors
    /// The fault, in one line.
    pub fn read(path: &Path) -> Result<Self, String> {
        if path.file_name().is_some_and(|name| name == COM3) && !path.exists() {
            return Database::parse(COM3_TEXT);
        }
        let failed = |reason: String| format!("{}: {reason}", path.display());
        let length = std::fs::metadata(path).map_err(|error| failed(error.to_string()))?.len();
        if length > LONGEST {
            return Err(failed(format!("{length} bytes are no DBC file; the longest that is read has {LONGEST}")));
        }
        let bytes = read_regular(path, ReadLimits::DEFAULT.document).map_err(|error| failed(error.to_string()))?;
        Self::parse(&bytes).map_err(failed)
    }

    /// Parses the bytes of a DBC file: UTF-8, or Windows code page 1252, which most of them use.
    ///
    /// # Errors
    /// The fault, in one line.
    pub fn parse(bytes: &[u8]) -> Result<Self, String> {
        let text = match std::str::from_utf8(bytes) {
            Ok(text) => text.into(),
            Err(_) => can_dbc::decode_cp1252(bytes).ok_or("neither UTF-8 nor code page 1252")?,
        };
        // The parser's messages have several lines with a sketch of the location.
        let dbc = Dbc::try_from(text.as_ref()).map_err(|error| {
            let text = error.to_string();
            format!("not understood as DBC: {}", text.split_whitespace().collect::<Vec<_>>().join(" "))
        })?;
        Ok(Database { dbc })
    }

    /// The position of a signal in its frame.
    ///
    /// # Errors
    /// The fault, in one line: no such message or signal, or a signal that does not fit into its message.
    pub fn place(&self, message: &str, signal: &str) -> Result<Place, String> {
        let found: Vec<&Message> = self.dbc.messages.iter().filter(|known| known.name == message).collect();
        let message = match found.as_slice() {
            [one] => *one,
            [] => return Err(format!("no message {message}; there are {}", names(&self.dbc.messages, |m| &m.name))),
            _ => return Err(format!("{} messages are named {message}", found.len())),
        };
        let signal = signal_of(message, signal)?;
        let bits = self.bits(message, signal)?;
        let number = |value: NumericValue| match value {
            NumericValue::Uint(value) => value as f64,
            NumericValue::Int(value) => value as f64,
            NumericValue::Double(value) => value,
        };
        let (least, largest) = (number(signal.min), number(signal.max));
        if !signal.factor.is_finite() || signal.factor == 0.0 || !signal.offset.is_finite() {
            let name = &signal.name;
            return Err(format!("{name}: factor {} and offset {} make no value", signal.factor, signal.offset));
        }
        let identifier = identifier(message);
        Ok(Place {
            identifier,
            mask: self.mask(identifier),
            bits,
            factor: signal.factor,
            offset: signal.offset,
            // [0|0] means no range.
            range: (least < largest).then_some((least, largest)),
            unit: signal.unit.clone(),
            selectors: self.selectors(message, signal)?,
        })
    }

    fn mask(&self, identifier: Identifier) -> u32 {
        const ALL: u32 = 0x1fff_ffff;
        let group = identifier.group_mask();
        let is_alike = |other: &&Message| {
            let other = self::identifier(other);
            other.extended && (other.number ^ identifier.number) & group == 0
        };
        if identifier.extended && self.dbc.messages.iter().filter(is_alike).count() == 1 { group } else { ALL }
    }

    fn bits(&self, message: &Message, signal: &Signal) -> Result<Bits, String> {
        let extended = self
            .dbc
            .signal_extended_value_type_list
            .iter()
            .find(|extended| extended.message_id == message.id && extended.signal_name == signal.name);
        let coding = match (extended.map(|extended| extended.signal_extended_value_type), signal.value_type) {
            (Some(SignalExtendedValueType::IEEEfloat32Bit), _) => Coding::Float32,
            (Some(SignalExtendedValueType::IEEEdouble64bit), _) => Coding::Float64,
            (_, ValueType::Signed) => Coding::Signed,
            (_, ValueType::Unsigned) => Coding::Unsigned,
        };
        let name = &signal.name;
        let allowed = match coding {
            Coding::Unsigned | Coding::Signed => 1..=64,
            Coding::Float32 => 32..=32,
            Coding::Float64 => 64..=64,
        };
        if !allowed.contains(&signal.size) {
            return Err(format!("{name}: {} bits cannot be a number of that type", signal.size));
        }
        let place = |value: u64| usize::try_from(value).unwrap_or(usize::MAX);
        let length = place(message.size).min(LONGEST_FRAME);
        let bits = Bits {
            start: place(signal.start_bit).min(8 * LONGEST_FRAME),
            length: place(signal.size),
            big_endian: signal.byte_order == ByteOrder::BigEndian,
            coding,
        };
        if bits.bytes() > length {
            return Err(format!("{name} ends in byte {} of a message of {length} bytes", bits.bytes()));
        }
        Ok(bits)
    }

    /// The multiplexers, from the signal up to the root.
    fn selectors(&self, message: &Message, signal: &Signal) -> Result<Vec<Selector>, String> {
        let mut selectors = Vec::new();
        let mut current = signal;
        while let MultiplexIndicator::MultiplexedSignal(value)
        | MultiplexIndicator::MultiplexorAndMultiplexedSignal(value) = current.multiplexer_indicator
        {
            if selectors.len() >= DEEPEST {
                return Err(format!("{}: multiplexers select each other", signal.name));
            }
            let extended = self
                .dbc
                .extended_multiplex
                .iter()
                .find(|extended| extended.message_id == message.id && extended.signal_name == current.name);
            let (selector, values) = match extended {
                Some(extended) => {
                    let ranges = extended.mappings.iter().map(|mapping| mapping.min_value..=mapping.max_value);
                    (signal_of(message, &extended.multiplexor_signal_name)?, ranges.collect())
                }
                None => {
                    let is_selector = |other: &&Signal| other.multiplexer_indicator == MultiplexIndicator::Multiplexor;
                    let selector = message.signals.iter().find(is_selector);
                    let selector = selector.ok_or_else(|| format!("{} has no multiplexer", message.name))?;
                    (selector, vec![value..=value])
                }
            };
            selectors.push((self.bits(message, selector)?, values));
            current = selector;
        }
        Ok(selectors)
    }
}

fn identifier(message: &Message) -> Identifier {
    match message.id {
        MessageId::Standard(number) => Identifier { number: number.into(), extended: false },
        MessageId::Extended(number) => Identifier { number, extended: true },
    }
}

fn signal_of<'m>(message: &'m Message, name: &str) -> Result<&'m Signal, String> {
    message.signals.iter().find(|signal| signal.name == name).ok_or_else(|| {
        format!("no signal {name} in message {}; there are {}", message.name, names(&message.signals, |s| &s.name))
    })
}

/// The first few names of a list.
fn names<T>(all: &[T], name: impl Fn(&T) -> &String) -> String {
    const MOST: usize = 12;
    let mut words: Vec<&str> = all.iter().take(MOST).map(|one| name(one).as_str()).collect();
    if all.len() > MOST {
        words.push("…");
    }
    if words.is_empty() { "none".to_string() } else { words.join(", ") }
}

impl Database {
    /// Names of messages and their signals.
    pub fn all_signals(&self) -> Vec<(String, String)> {
        let of = |message: &Message| {
            let name = message.name.clone();
            message.signals.iter().map(move |signal| (name.clone(), signal.name.clone())).collect::<Vec<_>>()
        };
        self.dbc.messages.iter().flat_map(of).collect()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use serde_json::Value;

    use super::*;

    const EXAMPLE: &[u8] = include_bytes!("../../tests/can/excavator.dbc");
    /// Random signals and frames with the values that cantools (PyPI) reads from them; generated by the script next to
    /// the file.
    const VECTORS: &str = include_str!("../../tests/can/vectors.json");

    fn bytes(hexadecimal: &str) -> Vec<u8> {
        let pairs = (0..hexadecimal.len()).step_by(2);
        pairs.map(|at| u8::from_str_radix(&hexadecimal[at..at + 2], 16).unwrap()).collect()
    }

    #[test]
    fn every_number_is_that_of_an_independent_reader() {
        let vectors: Value = serde_json::from_str(VECTORS).unwrap();
        let database = Database::parse(vectors["dbc"].as_str().unwrap().as_bytes()).unwrap();
        let (mut read, mut absent) = (0, 0);
        for frame in vectors["frames"].as_array().unwrap() {
            let message = frame["message"].as_str().unwrap();
            let data = bytes(frame["data"].as_str().unwrap());
            for (name, bits) in frame["values"].as_object().unwrap() {
                let place = database.place(message, name).unwrap();
                let expected = f64::from_bits(u64::from_str_radix(bits.as_str().unwrap(), 16).unwrap());
                assert!(place.is_selected(&data), "{message}.{name}");
                let value = place.value(&data).unwrap();
                // The reference may round once more or once less.
                let tolerance = 4.0 * f64::EPSILON * value.abs().max(place.offset.abs());
                assert!((value - expected).abs() <= tolerance, "{message}.{name}: {value}, not {expected}");
                read += 1;
            }
            for name in frame["absent"].as_array().unwrap() {
                let place = database.place(message, name.as_str().unwrap()).unwrap();
                assert!(!place.is_selected(&data), "{message}.{name}");
                absent += 1;
            }
        }
        assert!(read > 700 && absent > 400, "{read} numbers, {absent} absent");
    }

    #[test]
    fn a_frame_that_is_too_short_has_no_value() {
        let place = Database::parse(EXAMPLE).unwrap().place("ArmPressures", "RodPressure").unwrap();
        assert_eq!(place.value(&[0x64, 0, 0xc8, 0]), Some(4.0));
        assert_eq!(place.value(&[0x64, 0, 0xc8]), None);
    }

    #[test]
    fn the_range_is_that_of_the_file() {
        let database = Database::parse(EXAMPLE).unwrap();
        assert_eq!(database.place("ArmMotion", "Speed").unwrap().range(), Some((-2000.5, 2000.5)));
        assert_eq!(database.place("ValveState", "OrificeArea").unwrap().range(), Some((-200.0, 200.0)));
        let none = b"BO_ 1 M: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n";
        assert_eq!(Database::parse(none).unwrap().place("M", "S").unwrap().range(), None);
    }

    #[test]
    fn any_source_and_priority_of_a_parameter_group_carry_the_signal() {
        let com3 = Database::read(Path::new("com3")).unwrap();
        let place = com3.place("Pressure_1", "boom_cylinder_bottom_pressure").unwrap();
        let frame = |number| Identifier { number, extended: true };
        let own = place.identifier().number;
        assert!(place.is_in(frame(own)) && place.is_in(frame(own & 0xffff_ff00 | 0x21)));
        assert!(place.is_in(frame(own & 0x03ff_ffff | 0x0c00_0000)) && !place.is_in(frame(own ^ 0x100)));
        assert!(!place.is_in(Identifier { number: own & 0x7ff, extended: false }));
        // Two messages of one group are told apart by their addresses.
        let two = b"BO_ 2566879720 A: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n\nBO_ 2566879721 B: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n";
        let place = Database::parse(two).unwrap().place("A", "S").unwrap();
        assert!(place.is_in(place.identifier()) && !place.is_in(frame(place.identifier().number + 1)));
        // A message with a destination goes to any.
        let asked = b"BO_ 2565472526 R: 8 N\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" N\n";
        let place = Database::parse(asked).unwrap().place("R", "S").unwrap();
        assert!(place.is_in(frame(place.identifier().number & 0xffff_0000 | 0x0733)));
    }

    /// Values that cantools (PyPI) reads with the published file of the interface.
    #[test]
    fn the_built_in_file_reads_what_the_published_one_does() {
        let vectors: Value = serde_json::from_str(include_str!("../../tests/can/com3.json")).unwrap();
        let com3 = Database::read(Path::new("com3")).unwrap();
        let mut read = 0;
        for frame in vectors.as_array().unwrap() {
            let (message, data) = (frame["message"].as_str().unwrap(), bytes(frame["data"].as_str().unwrap()));
            for (signal, value) in frame["values"].as_object().unwrap() {
                let place = com3.place(message, signal).unwrap();
                assert_eq!(u64::from(place.identifier().number), frame["id"].as_u64().unwrap(), "{message}");
                let (found, expected) = (place.value(&data).unwrap(), value.as_f64().unwrap());
                assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{signal}: {found}, {expected}");
                read += 1;
            }
        }
        assert_eq!((com3.all_signals().len(), read), (114, 114 * 3));
    }

    #[test]
    fn code_page_1252_is_read() {
        let database = Database::parse(b"BO_ 1 M: 8 N\n SG_ T : 0|8@1+ (1,-40) [0|0] \"\xb0C\" N\n").unwrap();
        assert_eq!(database.place("M", "T").unwrap().value(&[50]), Some(10.0));
    }

    #[test]
    fn what_cannot_be_is_refused_with_a_reason() {
        let example = Database::parse(EXAMPLE).unwrap();
        let refused = |message: &str, signal: &str| example.place(message, signal).unwrap_err();
        assert!(refused("Nothing", "CapPressure").contains("ArmPressures"));
        assert!(refused("ArmPressures", "Nothing").contains("CapPressure"));
        let of = |line: &str, more: &str| {
            let text = format!("BO_ 1 M: 2 N\n SG_ S {line} [0|0] \"\" N\n\n{more}");
            Database::parse(text.as_bytes()).and_then(|database| database.place("M", "S"))
        };
        for (line, more, word) in [
            (": 8|9@1+ (1,0)", "", "byte 3 of a message of 2"),
            (": 0|10@0+ (1,0)", "", "byte 3"),
            (": 0|65@1+ (1,0)", "", "65 bits"),
            (": 0|16@1+ (0,0)", "", "factor 0"),
            (": 0|16@1- (1,0)", "SIG_VALTYPE_ 1 S : 1;\n", "16 bits"),
            ("m1 : 0|8@1+ (1,0)", "", "no multiplexer"),
            ("m1M : 0|8@1+ (1,0)", "SG_MUL_VAL_ 1 S S 1-1;\n", "select each other"),
        ] {
            let refusal = of(line, more);
            assert!(refusal.as_ref().is_err_and(|reason| reason.contains(word)), "{word}: {refusal:?}");
        }
        assert!(Database::parse(b"not a database").is_err_and(|reason| !reason.contains('\n')));
    }
}
