//! Texts that are not bytes of ASCII and more: UTF-16, and lines that end as on old Macintoshes.

use std::io::{Read, Seek};

use encoding_rs::{Encoding, UTF_16BE, UTF_16LE};
use rosbag2::ReadLimits;

use super::fault::TableFault;

/// Bytes from which the encoding is detected.
const LOOKED_AT: u64 = 1 << 16;

/// The text in UTF-8 with usual line ends, if the source has another form; `None` if it can be read as it is.
pub(super) fn in_utf8<R: Read + Seek>(
    source: &mut R,
    bytes: u64,
    limits: &ReadLimits,
) -> Result<Option<Vec<u8>>, TableFault> {
    let mut head = Vec::new();
    source.rewind()?;
    source.by_ref().take(LOOKED_AT).read_to_end(&mut head)?;
    if head.starts_with(b"\xff\xfe\0\0") || head.starts_with(b"\0\0\xfe\xff") {
        return Err("it is text in UTF-32; save it as UTF-8".into());
    }
    let encoding = utf_16(&head);
    let has_old_ends = encoding.is_none() && head.contains(&b'\r') && !head.contains(&b'\n');
    if encoding.is_none() && !has_old_ends {
        return Ok(None);
    }
    // The text, and what it is made of.
    limits.check_memory(bytes.saturating_mul(3), bytes)?;
    source.rewind()?;
    let mut whole = Vec::new();
    source.take(bytes).read_to_end(&mut whole)?;
    let text = match encoding {
        Some(encoding) => encoding.decode_with_bom_removal(&whole).0.into_owned().into_bytes(),
        None => whole,
    };
    let has_old_ends = text.contains(&b'\r') && !text.contains(&b'\n');
    Ok(Some(if has_old_ends {
        text.iter().map(|byte| if *byte == b'\r' { b'\n' } else { *byte }).collect()
    } else {
        text
    }))
}

/// The kind of UTF-16, by its byte order mark, or by the zeros that it has beside every letter of a table.
fn utf_16(head: &[u8]) -> Option<&'static Encoding> {
    if let Some((encoding, _)) = Encoding::for_bom(head) {
        return [UTF_16LE, UTF_16BE].into_iter().find(|known| *known == encoding);
    }
    let pairs = head.len() / 2;
    let zeros = |at: usize| head.chunks_exact(2).filter(|pair| pair[at] == 0).count();
    let (first, second) = (zeros(0), zeros(1));
    // Few letters of a table are beyond the first 256, and no letter is zero.
    let is = |zeros: usize, others: usize| pairs >= 2 && 10 * zeros >= 7 * pairs && 20 * others <= pairs;
    match () {
        () if is(second, first) => Some(UTF_16LE),
        () if is(first, second) => Some(UTF_16BE),
        () => None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn read(bytes: &[u8]) -> Option<String> {
        let found = in_utf8(&mut Cursor::new(bytes), bytes.len() as u64, &ReadLimits::DEFAULT).unwrap();
        found.map(|text| String::from_utf8(text).unwrap())
    }

    #[test]
    fn sixteen_bits_are_recognised_with_and_without_a_mark() {
        let text = "t [s];p [bar];Öl [°C]\n0;1,5;20\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        for bytes in
            [little.clone(), big.clone(), [&[0xff, 0xfe], &little[..]].concat(), [&[0xfe, 0xff], &big[..]].concat()]
        {
            assert_eq!(read(&bytes).as_deref(), Some(text));
        }
        for plain in [text.as_bytes(), b"\xef\xbb\xbft;p", b"", b"t", b"t;\xb0C\r\n0;1\r\n"] {
            assert_eq!(read(plain), None);
        }
        assert_eq!(read(b"t;p\r0;1\r").as_deref(), Some("t;p\n0;1\n"));
    }
}
