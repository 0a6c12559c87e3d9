//! What fuzz targets call: all that the bridge does with the bytes of other people's files.

use super::log::frames;
use super::{Counts, Database, Wanted};

/// A log for the signals of a database to be read from.
const LOG: &[u8] = include_bytes!("../../../../config/can/arm.log");
/// So much of it is read.
const LENGTH: usize = 2_000;
/// The database whose signals are read from logs.
const DATABASE: &[u8] = include_bytes!("../../../../config/can/excavator.dbc");

/// Bytes as a DBC file: how many signals have a place in their message; `None` for what is no DBC file.
pub fn can_database(bytes: &[u8]) -> Option<usize> {
    let wanted = wanted(&Database::parse(bytes).ok()?);
    read(LOG.get(..LENGTH).unwrap_or(LOG), &wanted);
    Some(wanted.places.len())
}

/// Bytes as a log: how many frames it has, and how many lines are none.
pub fn can_log(bytes: &[u8]) -> (u64, u64) {
    read(bytes, &Database::parse(DATABASE).map(|database| wanted(&database)).unwrap_or(Wanted { places: Vec::new() }))
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
