//! A topic map in text form.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use excavator_model::document::toml_fault;
use rosbag2::{ReadLimits, read_regular_text};
use serde::{Deserialize, Serialize};

use super::clock_source::ClockSource;
use super::conversion::Conversion;
use super::error::MapError;
use super::join::Join;
use super::leave_out::LeaveOut;
use super::named::NamedColumn;
use super::signal_source::SignalSource;
use crate::BagError;
use crate::table::TableFormat;

/// Which field of which topic, or which column of which table, is which signal.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TopicMap {
    /// What the map is for, for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// `.msg` files with types that neither the bag nor we define; relative to the map's own file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub definitions: Vec<PathBuf>,
    /// DBC file that says where signals stand in CAN frames; relative to the map's own file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dbc: Option<PathBuf>,
    /// At which times the recording has samples.
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub clock: ClockSource,
    /// How a text table is laid out; most of it is found out without.
    #[serde(default, skip_serializing_if = "super::is_default")]
    pub table: TableFormat,
    /// Other tables of the same time, whose columns are available too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub join: Vec<Join>,
    /// Names for columns and fields, for formulas.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub names: BTreeMap<String, NamedColumn>,
    /// The signals; what is not here is not measured.
    #[serde(default)]
    pub signals: Vec<SignalSource>,
    /// What is not compared with a model.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub leave_out: Vec<LeaveOut>,
}

impl TopicMap {
    /// Reads the map at `path`; paths of its definition files are relative to it.
    ///
    /// # Errors
    /// [`rosbag2::Error::Io`], [`BagError::Map`].
    pub fn read(path: &Path) -> Result<TopicMap, BagError> {
        let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
        let mut map: TopicMap =
            text.parse().map_err(|source| MapError::InFile { path: path.to_path_buf(), source: Box::new(source) })?;
        let folder = path.parent().unwrap_or(Path::new("."));
        for beside in map.definitions.iter_mut().chain(&mut map.dbc) {
            *beside = folder.join(&*beside);
        }
        Ok(map)
    }

    /// The map file of a bag or table, if it exists: `map.toml` in the folder of a bag, or `FILE.map.toml` next to a
    /// file.
    pub fn beside(data: &Path) -> Option<PathBuf> {
        let path = if data.is_dir() {
            data.join("map.toml")
        } else {
            let mut name = data.file_name()?.to_os_string();
            name.push(".map.toml");
            data.with_file_name(name)
        };
        path.is_file().then_some(path)
    }

    /// The map as text that parses back to the same map.
    ///
    /// # Errors
    /// [`MapError::Syntax`] if TOML cannot represent a number.
    pub fn to_text(&self) -> Result<String, MapError> {
        toml::to_string(self).map_err(|error| MapError::Syntax(error.to_string().into()))
    }

    fn check(&self) -> Result<(), MapError> {
        if self.signals.is_empty() {
            return Err(MapError::NoSignals);
        }
        let mut seen = BTreeSet::new();
        for source in &self.signals {
            if !seen.insert(&source.signal) {
                return Err(MapError::SignalTwice { signal: source.signal.to_string() });
            }
            source.check()?;
            if !source.may_learn_its_unit() {
                Conversion::of(source, None)?;
            }
            if source.message.is_some() && self.dbc.is_none() {
                return Err(MapError::NoDbc { place: source.signal.to_string() });
            }
        }
        for (name, named) in &self.names {
            named.check(name)?;
            if named.message.is_some() && self.dbc.is_none() {
                return Err(MapError::NoDbc { place: format!("[names] {name}") });
            }
        }
        self.join.iter().try_for_each(Join::check)?;
        self.clock.check("[clock]")
    }
}

impl FromStr for TopicMap {
    type Err = MapError;

    fn from_str(text: &str) -> Result<Self, MapError> {
        let map: TopicMap = toml::from_str(text).map_err(|error| MapError::Syntax(toml_fault(text, &error)))?;
        map.check()?;
        Ok(map)
    }
}
