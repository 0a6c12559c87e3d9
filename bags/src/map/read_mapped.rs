//! Reads data of any format with its map as a recording.

use std::ops::ControlFlow;
use std::path::Path;

use excavator_model::recording::Recording;

use super::document::TopicMap;
use super::opera;
use super::read_bag::read_bag;
use super::read_table::read_table;
use super::table_clock::{Dating, EPOCH_SECONDS};
use crate::can::is_frame_log;
use crate::info::{SignalsInfo, SignalsTally};
use crate::reading::{ReadReport, read_recording, read_recording_in_blocks};
use crate::table::Table;
use crate::{BagError, Topics};

/// Reads the signals of a map from the data at `path`: a bag in any storage, or a table (see
/// [`Table::is_table`]).
///
/// The clock is the one in the map; every signal is resampled to it as the map specifies. Signals that are not in the
/// map, or are missing at a time, are `NaN`. The report contains what was dropped, sorted, damaged or missing.
///
/// # Errors
/// [`BagError::Map`] if the map does not fit the data; all of [`RawMessages::open`](rosbag2::RawMessages::open);
/// [`BagError::NoTopic`], [`BagError::NoMessages`], [`BagError::Undecodable`] for a mapped topic;
/// [`BagError::BadTable`], [`rosbag2::Error::BadDefinition`].
pub fn read_mapped(path: &Path, map: &TopicMap) -> Result<(Recording, ReadReport), BagError> {
    read_dated(path, map).map(|(recording, report, _)| (recording, report))
}

/// As [`read_mapped`]; also returns the kind of the times.
pub(super) fn read_dated(path: &Path, map: &TopicMap) -> Result<(Recording, ReadReport, Dating), BagError> {
    let (mut recording, mut report, dating) = if Table::is_table(path) && !is_frame_log(path) {
        read_table(path, Table::read(path, &map.table)?, map)?
    } else {
        read_bag(path, map)?
    };
    for stretch in &map.leave_out {
        stretch.apply(&mut recording, &mut report)?;
    }
    Ok((recording, report, dating))
}

/// Options for finding signals in data.
#[derive(Debug, Clone, Copy, Default)]
pub struct Origin<'o> {
    /// File of a map, or the name of a built-in one ([`OPERA`](super::OPERA)); if not given, the map next to the data is used, if it
    /// exists (see [`TopicMap::beside`]).
    pub map: Option<&'o Path>,
    /// Namespace of the machine in a bag of our own topics; if not given, see [`Topics::in_bag`].
    pub namespace: Option<&'o str>,
}

/// Reads the data at `path` with a map, or without one as a bag of our own topics.
///
/// ```no_run
/// use std::path::Path;
///
/// use excavator_bags::map::{Origin, read_recording_or_mapped};
///
/// let origin = Origin { map: Some(Path::new("test_stand.toml")), ..Origin::default() };
/// let (recording, report) = read_recording_or_mapped(Path::new("pressures.csv"), origin)?;
/// println!("{} samples; {}", recording.len(), report.problems().join("; "));
/// # Ok::<(), excavator_bags::BagError>(())
/// ```
///
/// # Errors
/// All of [`read_mapped`], [`Topics::in_bag`] and [`read_recording`](crate::read_recording); [`BagError::BadTable`] for
/// a table without a map.
pub fn read_recording_or_mapped(path: &Path, origin: Origin<'_>) -> Result<(Recording, ReadReport), BagError> {
    let map = map_of(path, origin.map, origin.namespace)?;
    read_with(path, map.as_ref(), origin.namespace).map(|(recording, report, _)| (recording, report))
}

/// Summarizes the signals of the data at `path`, read as by [`read_recording_or_mapped`]. A bag of our own topics is
/// read in blocks, so that memory does not grow with its length.
///
/// # Errors
/// As [`read_recording_or_mapped`].
pub fn read_signals(path: &Path, origin: Origin<'_>) -> Result<(SignalsInfo, ReadReport), BagError> {
    let map = map_of(path, origin.map, origin.namespace)?;
    if map.is_some() || Table::is_table(path) || is_frame_log(path) {
        let (recording, report, _) = read_with(path, map.as_ref(), origin.namespace)?;
        return Ok((SignalsInfo::of(&recording), report));
    }
    let mut tally = SignalsTally::default();
    let report = read_recording_in_blocks(path, &Topics::in_bag(path, origin.namespace)?, BLOCK, |block| {
        tally.add(&block);
        ControlFlow::Continue(())
    })?;
    Ok((tally.info(), report))
}

/// Number of samples in memory at a time.
const BLOCK: usize = 20_000;

/// The map in the given file or of the given name, otherwise the one next to the data, if it exists.
pub(super) fn map_of(data: &Path, map: Option<&Path>, namespace: Option<&str>) -> Result<Option<TopicMap>, BagError> {
    if !data.exists() {
        return Err(rosbag2::Error::DoesNotExist { path: data.to_path_buf() }.into());
    }
    match map {
        Some(name) if name == Path::new(opera::OPERA) && !name.exists() => opera::map(data, namespace).map(Some),
        _ => map.map(Path::to_path_buf).or_else(|| TopicMap::beside(data)).map(|map| TopicMap::read(&map)).transpose(),
    }
}

/// Reads data with this map, or without one as a bag of our own topics.
pub(super) fn read_with(
    path: &Path,
    map: Option<&TopicMap>,
    namespace: Option<&str>,
) -> Result<(Recording, ReadReport, Dating), BagError> {
    match map {
        Some(map) => read_dated(path, map),
        None if is_frame_log(path) => Err(BagError::BadTable {
            path: path.to_path_buf(),
            reason:
                "a log of CAN frames needs a map with a DBC file: give one with --map; --map opera reads frames of COM3"
                    .to_string(),
        }),
        None if Table::is_table(path) => Err(BagError::BadTable {
            path: path.to_path_buf(),
            reason: "a table needs a map that says which column is which signal: give one with --map, or let \
                     `excavator import --guess` propose one"
                .to_string(),
        }),
        None => {
            let (recording, report) = read_recording(path, &Topics::in_bag(path, namespace)?)?;
            let is_dated = recording.start_nanoseconds as f64 / 1e9 > EPOCH_SECONDS;
            Ok((recording, report, if is_dated { Dating::Dated } else { Dating::Undated(0) }))
        }
    }
}
