//! Topic maps: files, Python dicts, and guesses.

use std::path::{Path, PathBuf};

use excavator_bags::map::{TopicMap, guess};
use pyo3::prelude::*;

use crate::errors::{ReadError, of_bag, of_map};
use crate::json;

/// A map as given from Python.
pub enum Map {
    /// A file.
    File(PathBuf),
    /// The same content as a `dict`.
    Table(Box<TopicMap>),
}

impl Map {
    /// A path, or a `dict` with the keys of a map file.
    pub fn of(given: &Bound<'_, PyAny>) -> PyResult<Map> {
        if let Ok(path) = given.extract::<PathBuf>() {
            return Ok(Map::File(path));
        }
        let text =
            toml::to_string(&json::from_python(given)?).map_err(|error| ReadError::new_err(error.to_string()))?;
        Ok(Map::Table(Box::new(text.parse::<TopicMap>().map_err(of_map)?)))
    }

    /// The map itself.
    pub fn read(self) -> PyResult<TopicMap> {
        match self {
            Map::File(path) => TopicMap::read(&path).map_err(of_bag),
            Map::Table(map) => Ok(*map),
        }
    }
}

/// A first map for the data at `path`, as TOML with a reason on each line.
#[pyfunction]
#[pyo3(signature = (path, cylinder = "arm"))]
pub fn guess_map(py: Python<'_>, path: PathBuf, cylinder: &str) -> PyResult<String> {
    py.detach(|| {
        let guessed = guess(Path::new(&path), cylinder).map_err(of_bag)?;
        guessed.to_text().map_err(of_map)
    })
}
