//! Any data with its map as a recording.

use std::path::Path;

use excavator_model::recording::Recording;

use super::document::TopicMap;
use super::read_bag::read_bag;
use super::read_table::read_table;
use crate::reading::{ReadReport, read_recording};
use crate::table::Table;
use crate::{BagError, Topics};

/// Reads the signals of a map from the data at `path`: a bag in any storage, or a table (see
/// [`Table::is_table`]).
///
/// The clock is that of the map; every signal is brought onto it as the map says. Signals that the map does not have, or
/// that are missing at a time, are `NaN`. What was dropped, sorted, damaged or missing is in the report.
///
/// # Errors
/// [`BagError::Map`] when the map does not fit the data; all of [`RawMessages::open`](crate::RawMessages::open);
/// [`BagError::NoTopic`], [`BagError::NoMessages`], [`BagError::Undecodable`] for a mapped topic;
/// [`BagError::BadTable`], [`BagError::BadDefinition`].
pub fn read_mapped(path: &Path, map: &TopicMap) -> Result<(Recording, ReadReport), BagError> {
    if Table::is_table(path) {
        let table = Table::read(path, &map.table)?;
        return Ok(read_table(path, &table, map)?);
    }
    read_bag(path, map)
}

/// Reads the data at `path` with the given map, else with the one beside it (see [`TopicMap::beside`]), else as a bag of
/// our own topics.
///
/// # Errors
/// All of [`read_mapped`] and [`read_recording`](crate::read_recording); [`BagError::BadTable`] for a table without map.
pub fn read_recording_or_mapped(path: &Path, map: Option<&Path>) -> Result<(Recording, ReadReport), BagError> {
    if !path.exists() {
        return Err(BagError::DoesNotExist { path: path.to_path_buf() });
    }
    match map.map(Path::to_path_buf).or_else(|| TopicMap::beside(path)) {
        Some(map) => read_mapped(path, &TopicMap::read(&map)?),
        None if Table::is_table(path) => Err(BagError::BadTable {
            path: path.to_path_buf(),
            reason: "a table needs a map that says which column is which signal: give one with --map, or let \
                     `excavator import --guess` propose one"
                .to_string(),
        }),
        None => read_recording(path, &Topics::default()),
    }
}
