//! Reads MATLAB versions 5 to 7: elements with a tag, variables compressed with zlib (MAT-File Format, chapter 1).

use std::io::Read;

use rosbag2::{LimitError, ReadLimits};

use super::fault::TableFault;
use super::mat_variables::{Budget, Content, Number, Variable};
use super::split::decoded;

const HEADER: usize = 128;
/// Maximum nesting of structs.
const DEPTH_LIMIT: usize = 8;

/// Maximum number of dimensions of an array, and of bytes of a name; real ones have three and 63.
const DIMENSION_LIMIT: usize = 32;
const NAME_LIMIT: usize = 256;

const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
const STRUCT_CLASS: u8 = 2;
const CHAR_CLASS: u8 = 4;
/// Objects of a class: those of old classes, and all others, as a `timeseries`.
const OBJECT_CLASSES: [u8; 2] = [3, 17];
const UINT8_CLASS: u8 = 9;
/// Maximum number of elements of an array of structs.
const ELEMENT_LIMIT: f64 = 1024.0;
/// Maximum length of a text that may be a name or a unit.
const TEXT_LIMIT: usize = 256;
/// Classes of real numbers: double, single, and integers of 8 to 64 bits.
const NUMERIC_CLASSES: std::ops::RangeInclusive<u8> = 6..=15;
const COMPLEX_FLAG: u8 = 0x08;

/// Whether the bytes start like a file of these versions.
pub(super) fn is_mat5(bytes: &[u8]) -> bool {
    matches!(bytes.get(124..128), Some([0, 1, b'I', b'M'] | [1, 0, b'M', b'I']))
}

/// The real numeric arrays and the texts in a file, those in structs as `struct.field` and `structs(2).field`; others are added to
/// `notes`.
pub(super) fn parse(bytes: &[u8], notes: &mut Vec<String>, limits: &ReadLimits) -> Result<Content, TableFault> {
    let big_endian = bytes.get(126) == Some(&b'M');
    let mut found = Found { content: Content::default(), notes, budget: Budget::new(limits, bytes), fault: None };
    let mut reader = Elements { rest: bytes.get(HEADER..).unwrap_or_default(), big_endian };
    while !reader.rest.is_empty() {
        let left = reader.rest.len();
        let Some(element) = reader.next() else {
            found.notes.push(format!("the last {left} bytes are no whole variable: the file is cut off"));
            break;
        };
        if element.kind != COMPRESSED {
            found.take(&element, big_endian)?;
            continue;
        }
        match unpack(&element, big_endian, &found.budget)? {
            Ok(unpacked) => match (Elements { rest: &unpacked, big_endian }.next()) {
                Some(inner) => found.take(&inner, big_endian)?,
                None => found.notes.push("a variable is cut off after unpacking".to_string()),
            },
            Err(error) => found.notes.push(format!("a variable cannot be unpacked: {error}")),
        }
    }
    Ok(found.content)
}

/// The bytes of a compressed variable. No more bytes are decompressed than its own tag announces.
fn unpack(element: &Element, big_endian: bool, budget: &Budget) -> Result<std::io::Result<Vec<u8>>, LimitError> {
    let mut decoder = flate2::read::ZlibDecoder::new(element.content);
    let mut tag = [0; 8];
    if let Err(error) = decoder.read_exact(&mut tag) {
        return Ok(Err(error));
    }
    let tag_only = Elements { rest: &tag, big_endian };
    let (Some(kind), Some(length)) = (tag_only.word(0), tag_only.word(4)) else { return Ok(Ok(Vec::new())) };
    // The content of a small element is in its tag.
    let length = if kind >> 16 == 0 { u64::from(length) } else { 0 };
    budget.unpacks_to(length)?;
    let mut unpacked = Vec::with_capacity(tag.len() + usize::try_from(length).unwrap_or_default());
    unpacked.extend_from_slice(&tag);
    // Padding to a multiple of eight bytes follows.
    Ok(decoder.take(length + 8).read_to_end(&mut unpacked).map(|_| unpacked))
}

struct Element<'b> {
    kind: u32,
    content: &'b [u8],
}

/// Elements one after the other.
struct Elements<'b> {
    rest: &'b [u8],
    big_endian: bool,
}

impl<'b> Elements<'b> {
    /// The next element; `None` if there is no complete one.
    fn next(&mut self) -> Option<Element<'b>> {
        let first = self.word(0)?;
        // Up to four bytes of content may be in the tag itself; then the length is in its upper half.
        if first >> 16 != 0 {
            let length = (first >> 16) as usize;
            let content = self.rest.get(4..8)?.get(..length)?;
            self.rest = self.rest.get(8..)?;
            return Some(Element { kind: first & 0xffff, content });
        }
        let length = self.word(4)? as usize;
        let content = self.rest.get(8..)?.get(..length)?;
        let end = 8 + length;
        // Compressed elements are not padded. All others are padded to eight bytes, except perhaps the last.
        let end = if first == COMPRESSED { end } else { end.next_multiple_of(8).min(self.rest.len()) };
        self.rest = self.rest.get(end..)?;
        Some(Element { kind: first, content })
    }

    fn word(&self, at: usize) -> Option<u32> {
        let bytes = self.rest.get(at..at + 4)?.try_into().ok()?;
        Some(if self.big_endian { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) })
    }
}

/// The name in a byte field, terminated by a zero.
fn name_in(bytes: &[u8]) -> String {
    let name = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
    String::from_utf8_lossy(name.get(..NAME_LIMIT).unwrap_or(name)).into_owned()
}

/// The text of an array of characters: in 8 or 16 bits each.
fn text_in(element: &Element, big_endian: bool) -> String {
    let text = match element.kind {
        // 16 bits: MATLAB writes them as numbers or as UTF-16.
        4 | 17 => {
            let pairs = element.content.chunks_exact(2).take(TEXT_LIMIT);
            let units = pairs.map(|pair| if big_endian { [pair[1], pair[0]] } else { [pair[0], pair[1]] });
            String::from_utf16_lossy(&units.map(u16::from_le_bytes).collect::<Vec<u16>>())
        }
        _ => decoded(element.content.get(..TEXT_LIMIT).unwrap_or(element.content)).into_owned(),
    };
    text.trim_matches(|c: char| c.is_control() || c.is_whitespace()).to_string()
}

struct Found<'n> {
    content: Content,
    notes: &'n mut Vec<String>,
    budget: Budget<'n>,
    /// Set when the budget is exhausted.
    fault: Option<LimitError>,
}

impl Found<'_> {
    fn take(&mut self, element: &Element, big_endian: bool) -> Result<(), LimitError> {
        self.budget.take(0)?;
        let before = self.notes.len();
        if element.kind != MATRIX {
            self.notes.push(format!("an element of type {} was left out", element.kind));
        } else if self.matrix(element.content, big_endian, None, 0).is_none() && self.notes.len() == before {
            self.notes.push("a variable that makes no sense was left out".to_string());
        }
        self.fault.map_or(Ok(()), Err)
    }

    /// Counts a variable; `None` if it exceeds the budget.
    fn afford(&mut self, values: usize) -> Option<()> {
        self.fault = self.fault.or(self.budget.take(values).err());
        self.fault.is_none().then_some(())
    }

    /// Reads a matrix; `name` replaces its own. `None` if it is invalid.
    fn matrix(&mut self, content: &[u8], big_endian: bool, name: Option<String>, depth: usize) -> Option<()> {
        self.afford(0)?;
        if content.is_empty() {
            return Some(());
        }
        let mut parts = Elements { rest: content, big_endian };
        let flags = parts.next()?;
        let flags = Elements { rest: flags.content, big_endian }.word(0)?;
        let (class, flags) = ((flags & 0xff) as u8, (flags >> 8 & 0xff) as u8);
        if OBJECT_CLASSES.contains(&class) {
            // Objects of old classes have a size, as all other arrays.
            if class == OBJECT_CLASSES[0] {
                parts.next()?;
            }
            let name = name.unwrap_or_else(|| parts.next().map(|part| name_in(part.content)).unwrap_or_default());
            self.content.objects.push(name);
            return Some(());
        }
        let dimensions = parts.next()?.content;
        let dimensions = Number::I32.read(dimensions.get(..4 * DIMENSION_LIMIT).unwrap_or(dimensions), big_endian);
        let own_name = name_in(parts.next()?.content);
        let name = name.unwrap_or(own_name);
        let elements: f64 = dimensions.iter().product();
        if class == STRUCT_CLASS && (1.0..=ELEMENT_LIMIT).contains(&elements) && depth < DEPTH_LIMIT {
            return self.structures(&mut parts, &name, elements as usize, depth);
        }
        if class == CHAR_CLASS && depth > 0 {
            let text = text_in(&parts.next()?, big_endian);
            self.content.texts.push((name, text));
            return Some(());
        }
        // Where MATLAB keeps the content of objects.
        if name.is_empty() && class == UINT8_CLASS && !self.content.objects.is_empty() {
            return Some(());
        }
        if !NUMERIC_CLASSES.contains(&class) || flags & COMPLEX_FLAG != 0 {
            self.notes.push(format!("{name} is no real numeric array and was left out"));
            return Some(());
        }
        let data = parts.next()?;
        let number = match data.kind {
            1 => Number::I8,
            2 => Number::U8,
            3 => Number::I16,
            4 => Number::U16,
            5 => Number::I32,
            6 => Number::U32,
            7 => Number::F32,
            9 => Number::F64,
            12 => Number::I64,
            13 => Number::U64,
            _ => return None,
        };
        self.afford(data.content.len() / number.size())?;
        let values = number.read(data.content, big_endian);
        let rows = dimensions.first().filter(|&&rows| rows >= 0.0).map(|&rows| rows as usize)?;
        let announced: f64 = dimensions.iter().product();
        if announced != values.len() as f64 {
            self.notes.push(format!("{name} has {} values instead of {announced} and was left out", values.len()));
            return Some(());
        }
        self.content.variables.push(Variable { name, rows, values });
        Some(())
    }

    /// The fields of the structs in an array.
    fn structures(&mut self, parts: &mut Elements, name: &str, elements: usize, depth: usize) -> Option<()> {
        let length = Number::I32.read(parts.next()?.content, parts.big_endian);
        let length =
            length.first().filter(|&&length| (1.0..=256.0).contains(&length)).map(|&length| length as usize)?;
        let names = parts.next()?.content;
        for number in 1..=elements {
            let name = if elements == 1 { name.to_string() } else { format!("{name}({number})") };
            for field in names.chunks_exact(length) {
                let field = name_in(field);
                let element = parts.next()?;
                self.matrix(element.content, parts.big_endian, Some(format!("{name}.{field}")), depth + 1)?;
            }
        }
        Some(())
    }
}
