//! ROS 2 messages in serialized form: a 4-byte encapsulation header, then plain CDR.
//!
//! Alignment counts from the first byte after the encapsulation (DDS-XTypes 7.6.2).

use byteorder::{BigEndian, LittleEndian};
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

/// Representation identifier of plain CDR, little endian; what every ROS 2 node writes today.
const LITTLE_ENDIAN: [u8; 4] = [0x00, 0x01, 0x00, 0x00];
/// Writers pad a message at most to the next multiple of eight bytes.
const PADDING_LIMIT: usize = 7;

/// Why bytes cannot be decoded as a message, or a message cannot be encoded.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum CdrError {
    /// Fewer bytes than the encapsulation needs.
    #[error("{0} bytes are less than the 4 of the encapsulation")]
    NoEncapsulation(usize),
    /// An encapsulation other than plain CDR.
    #[error("encapsulation {0:#06x} is not plain CDR (0x0000 or 0x0001)")]
    OtherEncapsulation(u16),
    /// The bytes do not fit the type.
    #[error("{reason} in {bytes} bytes of content")]
    Malformed {
        /// Bytes after the encapsulation.
        bytes: usize,
        /// The decoder's message.
        reason: String,
    },
    /// Bytes are left over after the type.
    #[error("{left} of {bytes} bytes of content are left over")]
    LeftOver {
        /// Bytes after the encapsulation.
        bytes: usize,
        /// Bytes that the type does not use.
        left: usize,
    },
    /// The message cannot be encoded.
    #[error("{0}")]
    Unencodable(String),
}

/// Decodes a message from its bytes, with encapsulation, in either byte order.
///
/// # Errors
/// [`CdrError`], with the number of bytes; also when more than padding is left over, since the bytes were then written
/// for another type.
pub fn decode<M: DeserializeOwned>(bytes: &[u8]) -> Result<M, CdrError> {
    let Some((&[high, low, _, _], content)) = bytes.split_first_chunk::<4>() else {
        return Err(CdrError::NoEncapsulation(bytes.len()));
    };
    let decoded = match u16::from_be_bytes([high, low]) {
        0 => cdr_encoding::from_bytes::<M, BigEndian>(content),
        1 => cdr_encoding::from_bytes::<M, LittleEndian>(content),
        other => return Err(CdrError::OtherEncapsulation(other)),
    };
    let (message, used) =
        decoded.map_err(|error| CdrError::Malformed { bytes: content.len(), reason: error.to_string() })?;
    let left = content.len().saturating_sub(used);
    if left > PADDING_LIMIT {
        return Err(CdrError::LeftOver { bytes: content.len(), left });
    }
    Ok(message)
}

/// Encodes a message, little endian, with encapsulation.
///
/// # Errors
/// [`CdrError::Unencodable`] for types that CDR cannot represent; it can represent every ROS 2 message.
pub fn encode<M: Serialize>(message: &M) -> Result<Vec<u8>, CdrError> {
    let content =
        cdr_encoding::to_vec::<M, LittleEndian>(message).map_err(|error| CdrError::Unencodable(error.to_string()))?;
    let mut bytes = Vec::with_capacity(LITTLE_ENDIAN.len() + content.len());
    bytes.extend_from_slice(&LITTLE_ENDIAN);
    bytes.extend_from_slice(&content);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Term {
        effect: String,
        power: f64,
    }

    #[test]
    fn alignment_counts_from_the_end_of_the_encapsulation() {
        let term = Term { effect: "ab".into(), power: 1.0 };
        let bytes = encode(&term);
        // 4 encapsulation, 4 length, "ab\0", 1 padding to offset 8 of the content, 8 of the float.
        let expected = [0, 1, 0, 0, 3, 0, 0, 0, b'a', b'b', 0, 0, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f];
        assert_eq!(bytes, Ok(expected.to_vec()));
        assert_eq!(decode::<Term>(&expected), Ok(term));
    }

    #[test]
    fn big_endian_is_read_too() {
        let bytes = [0, 0, 0, 0, 0, 0, 0, 3, b'a', b'b', 0, 0, 0x3f, 0xf0, 0, 0, 0, 0, 0, 0];
        assert_eq!(decode(&bytes), Ok(Term { effect: "ab".into(), power: 1.0 }));
    }

    #[test]
    fn what_is_no_message_says_why() {
        assert_eq!(decode::<Term>(&[0, 1]), Err(CdrError::NoEncapsulation(2)));
        assert_eq!(decode::<Term>(&[0, 3, 0, 0]), Err(CdrError::OtherEncapsulation(3)));
        let short = [0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff];
        assert!(matches!(decode::<(Vec<String>, Vec<f64>)>(&short), Err(CdrError::Malformed { bytes: 4, .. })));
        let long = [[0u8, 1, 0, 0].as_slice(), &[0; 32]].concat();
        assert_eq!(decode::<Term>(&long), Err(CdrError::LeftOver { bytes: 32, left: 16 }));
    }
}
