//! Bags with topics of any type.

use std::path::PathBuf;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rosbag2::{BagInfo, RawMessages, info};

use crate::errors::{ReadError, of_bag};
use crate::topic_columns::{ColumnsError, topic_columns};

/// A bag: a rosbag2 folder, or a bare `.mcap` or `.db3` file.
#[pyclass(frozen, module = "excavator._native")]
pub struct Bag {
    path: PathBuf,
}

#[pymethods]
impl Bag {
    /// Opens the bag at `path`.
    #[new]
    fn new(path: PathBuf) -> PyResult<Self> {
        let _ = RawMessages::open(&path).map_err(of_bag)?;
        Ok(Bag { path })
    }

    /// The path.
    #[getter]
    fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// What is in it: name, type, number of messages and mean rate (Hz) of each topic, and problems. Reads through the whole bag.
    #[allow(clippy::type_complexity)]
    fn info(&self, py: Python<'_>) -> PyResult<(Vec<(String, String, u64, Option<f64>)>, Vec<String>, f64)> {
        let BagInfo { topics, problems, duration, .. } = py.detach(|| info(&self.path)).map_err(of_bag)?;
        let topics = topics.into_iter().map(|topic| {
            let rate = topic.mean_rate();
            (topic.name, topic.type_name, topic.message_count, rate)
        });
        Ok((topics.collect(), problems, duration))
    }

    /// One topic as columns, and how many messages could not be decoded.
    fn read<'py>(
        &self,
        py: Python<'py>,
        topic: &str,
        fields: Option<Vec<String>>,
    ) -> PyResult<(Bound<'py, PyDict>, u64)> {
        let columns =
            py.detach(|| topic_columns(&self.path, topic, fields.as_deref())).map_err(|error| match error {
                ColumnsError::Bag(error) => of_bag(error),
                other => ReadError::new_err(other.to_string()),
            })?;
        let found = PyDict::new(py);
        found.set_item("log_time", PyArray1::from_vec(py, columns.log_time))?;
        found.set_item("publish_time", PyArray1::from_vec(py, columns.publish_time))?;
        if let Some(times) = columns.header_time {
            found.set_item("header_time", PyArray1::from_vec(py, times))?;
        }
        for (name, values) in columns.fields {
            found.set_item(name, PyArray1::from_vec(py, values))?;
        }
        Ok((found, columns.undecodable))
    }
}
