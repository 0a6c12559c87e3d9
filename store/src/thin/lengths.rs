//! Splits bytes into records: a kind, a length and a body.

/// Eight bytes as a number.
pub(super) fn number(bytes: &[u8]) -> Option<u64> {
    bytes.first_chunk().map(|first| u64::from_le_bytes(*first))
}

/// Kind and body of the record that begins here.
pub(super) fn record(bytes: &[u8]) -> Option<(u8, &[u8])> {
    let (kind, rest) = bytes.split_first()?;
    let length = usize::try_from(number(rest)?).ok()?;
    Some((*kind, rest.get(8..8usize.checked_add(length)?)?))
}
