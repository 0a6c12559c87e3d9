//! Entry points of fuzz targets: everything that the bridge does with the bytes of foreign files.

use std::time::Instant;

use super::log::frames;
use super::{Counts, Database, Wanted};

/// Parses bytes as a DBC file and reads its signals from `log`. Returns how many signals have a place in their message; `None`
/// if the bytes are not a DBC file.
pub fn can_database(bytes: &[u8], log: &[u8]) -> Option<usize> {
    let wanted = wanted(&Database::parse(bytes).ok()?);
    read(log, &wanted);
    Some(wanted.places.len())
}

/// Parses bytes as a log and reads the signals of a DBC file from it. Returns the number of frames, and of lines that are not
/// frames.
pub fn can_log(bytes: &[u8], database: &[u8]) -> (u64, u64) {
    read(
        bytes,
        &Database::parse(database).map(|database| wanted(&database)).unwrap_or_else(|_| Wanted::new(Vec::new())),
    )
}

fn wanted(database: &Database) -> Wanted {
    let places =
        database.all_signals().into_iter().filter_map(|(message, signal)| database.place(&message, &signal).ok());
    Wanted::new(places.collect())
}

fn read(log: &[u8], wanted: &Wanted) -> (u64, u64) {
    let (counts, start) = (Counts::default(), Instant::now());
    let mut found = 0;
    for logged in frames(log, None, &counts) {
        found += 1;
        wanted.read(&logged.frame, start + logged.elapsed, &counts, |_, _| {});
    }
    (found, counts.unreadable.into_inner())
}
