//! Bytes as the file of a bag: MCAP, SQLite3, packed as a whole.

use std::io::Write;
use std::path::Path;

use excavator_bags::map::{guess, read_mapped};
use excavator_bags::{Topics, read_recording};
use excavator_model::recording::Recording;
use rosbag2::{RawMessages, info, reindex};

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
    let count = |path: &Path| RawMessages::open(path).map_or(0, |messages| messages.filter_map(Result::ok).count());
    let messages = count(path);
    if let Ok(done) = reindex(path, false)
        && done.files.iter().any(|file| file.rewritten)
    {
        made_whole(path, messages, count(path));
    }
    messages > 0
}

#[allow(clippy::panic)]
fn made_whole(path: &Path, before: usize, after: usize) {
    let damage = RawMessages::open(path).map(|mut messages| {
        messages.by_ref().for_each(drop);
        messages.damage()
    });
    if before != after || !damage.as_ref().is_ok_and(Vec::is_empty) {
        panic!("of {before} messages {after} are left, with {damage:?}");
    }
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
