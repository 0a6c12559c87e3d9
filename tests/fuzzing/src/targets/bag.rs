//! Bytes as the file of a bag: MCAP, SQLite3, packed as a whole.

use std::io::Write;

use excavator_bags::map::{guess, read_mapped};
use excavator_bags::{RawMessages, Topics, info, read_recording};
use excavator_model::recording::Recording;

use crate::samples;

/// # Panics
/// When a recording breaks its promises.
pub fn run(bytes: &[u8]) -> bool {
    let Ok(mut file) = tempfile::NamedTempFile::new() else { return false };
    if file.write_all(bytes).is_err() {
        return false;
    }
    let path = file.path();
    let _ = info(path);
    if let Ok((recording, _)) = read_recording(path, &Topics::default()) {
        check(&recording);
    }
    if let Ok(guessed) = guess(path, "arm")
        && let Ok((recording, _)) = read_mapped(path, &guessed.map())
    {
        check(&recording);
    }
    RawMessages::open(path).is_ok_and(|messages| messages.filter_map(Result::ok).count() > 0)
}

#[allow(clippy::panic)]
fn check(recording: &Recording) {
    if let Err(error) = recording.validate() {
        panic!("{error}");
    }
}

pub fn mcap_seeds() -> Vec<Vec<u8>> {
    vec![samples::bytes("bags/samples/arm-swing/arm-swing_0.mcap")]
}

pub fn sqlite_seeds() -> Vec<Vec<u8>> {
    vec![samples::bytes("bags/samples/joint-states/joint-states.db3")]
}

pub fn packed_seeds() -> Vec<Vec<u8>> {
    [mcap_seeds(), sqlite_seeds()].concat().iter().filter_map(|bytes| zstd::encode_all(&bytes[..], 3).ok()).collect()
}
