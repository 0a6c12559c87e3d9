//! Tables that were recorded in parallel with the data.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::clock_source::ClockSource;
use super::error::MapError;
use crate::table::TableFormat;

/// A table of the same time in another file.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Join {
    /// The file; relative to the data.
    pub file: PathBuf,
    /// Added to its times, s. Where only one of both says on which day it was: from the first row of the data to its own.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// Its times; as [`TopicMap::clock`](super::TopicMap).
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub clock: ClockSource,
    /// Its layout; as [`TopicMap::table`](super::TopicMap).
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub table: TableFormat,
}

/// Maximum offset, s: three years; a larger one is a mistake.
const LARGEST_OFFSET: f64 = 1e8;

impl Join {
    /// The table in a file, with default options.
    pub fn of(file: &Path) -> Join {
        Join { file: file.to_path_buf(), ..Join::default() }
    }

    pub(super) fn check(&self) -> Result<(), MapError> {
        let place = format!("[[join]] {}", self.file.display());
        if let Some(found) = self.offset.filter(|offset| offset.is_nan() || offset.abs() > LARGEST_OFFSET) {
            return Err(MapError::BadNumber { place, key: "offset", found, wanted: "under 1e8 s" });
        }
        if self.clock.topic.is_some() {
            return Err(MapError::KeyWithout { place, key: "clock.topic", wanted: "a bag; a joined file is a table" });
        }
        self.clock.check(&place)
    }
}
