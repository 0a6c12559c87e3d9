//! What fuzz targets call: all that the bridge does with the bytes of other people's files.

use super::log::frames;
use super::{Counts, Database, Wanted};

/// Bytes as a DBC file, whose signals are read from `log`: how many signals have a place in their message; `None` for what is no DBC file.
pub fn can_database(bytes: &[u8], log: &[u8]) -> Option<usize> {
    let wanted = wanted(&Database::parse(bytes).ok()?);
    read(log, &wanted);
    Some(wanted.places.len())
}

/// Bytes as a log, from which the signals of a DBC file are read: how many frames it has, and how many lines are none.
pub fn can_log(bytes: &[u8], database: &[u8]) -> (u64, u64) {
    read(bytes, &Database::parse(database).map(|database| wanted(&database)).unwrap_or(Wanted { places: Vec::new() }))
}

fn wanted(database: &Database) -> Wanted {
    let places =
        database.all_signals().into_iter().filter_map(|(message, signal)| database.place(&message, &signal).ok());
    Wanted { places: places.collect() }
}

fn read(log: &[u8], wanted: &Wanted) -> (u64, u64) {
    let counts = Counts::default();
    let mut found = 0;
    for logged in frames(log, None, &counts) {
        found += 1;
        wanted.read(&logged.frame, &counts, |_, _| {});
    }
    (found, counts.unreadable.into_inner())
}
