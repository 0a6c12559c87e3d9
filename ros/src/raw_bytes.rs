//! A message as bytes, and its way through the middleware without a type.

use rustdds::RepresentationIdentifier;
use rustdds::bytes::Bytes;
use rustdds::no_key::{Decode, DefaultDecoder, DeserializerAdapter, SerializerAdapter};

/// Length of the encapsulation in front of every message.
const ENCAPSULATION: usize = 4;

/// A message with its four bytes of encapsulation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct RawBytes(pub(super) Bytes);

/// Never happens: bytes are always bytes.
#[derive(Debug, thiserror::Error)]
#[error("bytes that are none")]
pub(super) struct NoError;

pub(super) struct RawAdapter;

#[derive(Clone)]
pub(super) struct RawDecoder;

impl DeserializerAdapter<RawBytes> for RawAdapter {
    type Error = NoError;
    type Decoded = RawBytes;

    fn supported_encodings() -> &'static [RepresentationIdentifier] {
        &[RepresentationIdentifier::CDR_LE, RepresentationIdentifier::CDR_BE]
    }

    fn transform_decoded(decoded: RawBytes) -> RawBytes {
        decoded
    }
}

impl DefaultDecoder<RawBytes> for RawAdapter {
    type Decoder = RawDecoder;
    const DECODER: RawDecoder = RawDecoder;
}

impl<'de> Decode<'de, RawBytes> for RawDecoder {
    type Error = NoError;

    fn decode_bytes(self, content: &'de [u8], encoding: RepresentationIdentifier) -> Result<RawBytes, NoError> {
        let little = u8::from(encoding != RepresentationIdentifier::CDR_BE);
        let mut bytes = Vec::with_capacity(ENCAPSULATION + content.len());
        bytes.extend_from_slice(&[0, little, 0, 0]);
        bytes.extend_from_slice(content);
        Ok(RawBytes(bytes.into()))
    }
}

impl SerializerAdapter<RawBytes> for RawAdapter {
    type Error = NoError;

    fn output_encoding() -> RepresentationIdentifier {
        RepresentationIdentifier::CDR_LE
    }

    fn to_bytes(value: &RawBytes) -> Result<Bytes, NoError> {
        Ok(value.0.slice(ENCAPSULATION.min(value.0.len())..))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_survive_the_round_trip() {
        let decoded = RawDecoder.decode_bytes(&[1, 2, 3], RepresentationIdentifier::CDR_LE);
        assert!(matches!(&decoded, Ok(RawBytes(bytes)) if bytes[..] == [0, 1, 0, 0, 1, 2, 3]));
        let encoded = decoded.and_then(|raw| RawAdapter::to_bytes(&raw));
        assert!(matches!(encoded, Ok(bytes) if bytes[..] == [1, 2, 3]));
        let big = RawDecoder.decode_bytes(&[1], RepresentationIdentifier::CDR_BE);
        assert!(matches!(big, Ok(RawBytes(bytes)) if bytes[..] == [0, 0, 0, 0, 1]));
    }
}
