//! Recordings: signals on one clock.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use excavator_bags::map::{Origin, SignalName, TopicMap, read_mapped, read_recording_or_mapped};
use excavator_bags::table::Table;
use excavator_bags::{ReadReport, Topics, write_recording};
use excavator_model::recording::{Recording as Signals, is_measured};
use excavator_study::recording_part::Part;
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use rosbag2::WriteOptions;

use crate::columns;
use crate::errors::{ReadError, of_bag, of_work};
use crate::mapping::Map;

/// The data of a recording, and how it was read.
pub struct Content {
    /// The signals.
    pub signals: Signals,
    /// Remarks and problems of the reader.
    pub report: ReadReport,
    /// Whether a map resampled the signals onto one clock, or the user passed them directly.
    pub is_mapped: bool,
}

/// Signals of one machine on one clock, in SI units.
#[pyclass(frozen, module = "excavator._native")]
pub struct Recording {
    content: Arc<Content>,
}

impl Recording {
    /// Wraps this content.
    pub fn of(content: Content) -> Self {
        Recording { content: Arc::new(content) }
    }

    /// A recording of signals that were computed, not read from a file.
    pub fn of_signals(signals: Signals) -> Self {
        Recording::of(Content { signals, report: ReadReport::default(), is_mapped: true })
    }

    /// The content, for work without the lock of the interpreter.
    pub fn content(&self) -> Arc<Content> {
        self.content.clone()
    }
}

#[pymethods]
impl Recording {
    /// From arrays: times in s, and values by signal name.
    #[staticmethod]
    fn from_columns(
        time: PyReadonlyArray1<'_, f64>,
        columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        source: &str,
        start_nanoseconds: i64,
    ) -> PyResult<Self> {
        let time = time.as_slice()?.to_vec();
        let mut names: Vec<(SignalName, &[f64])> = Vec::new();
        for (name, values) in &columns {
            let name = name.parse::<SignalName>().map_err(|error| PyValueError::new_err(format!("{error}")))?;
            names.push((name, values.as_slice()?));
        }
        let mut cylinders: Vec<&str> = Vec::new();
        for cylinder in names.iter().filter_map(|(name, _)| name.cylinder.as_deref()) {
            if !cylinders.contains(&cylinder) {
                cylinders.push(cylinder);
            }
        }
        let mut signals = Signals::unmeasured(source, time, &cylinders);
        signals.start_nanoseconds = start_nanoseconds;
        for (name, values) in &names {
            *name.column(&mut signals) = values.to_vec();
        }
        signals.validate().map_err(|error| ReadError::new_err(error.to_string()))?;
        Ok(Recording::of_signals(signals))
    }

    fn __len__(&self) -> usize {
        self.content.signals.len()
    }

    /// Where the signals come from.
    #[getter]
    fn source(&self) -> &str {
        &self.content.signals.source
    }

    /// Stamp of the first sample, ns since the Unix epoch.
    #[getter]
    fn start_nanoseconds(&self) -> i64 {
        self.content.signals.start_nanoseconds
    }

    /// Time from the first sample to the last, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.content.signals.duration()
    }

    /// Median time between samples, s.
    #[getter]
    fn sample_interval(&self) -> f64 {
        self.content.signals.sample_interval()
    }

    /// What was not perfect in the data, one line each.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        self.content.report.problems()
    }

    /// Times of the samples, s after the first.
    #[getter]
    fn time<'py>(slf: &Bound<'py, Self>) -> Option<Bound<'py, PyArray1<f64>>> {
        columns::view(slf, |own| Some(own.content.signals.time.as_slice()))
    }

    /// Names of all signals with their units, and whether any value was measured.
    fn names(&self) -> Vec<(String, &'static str, bool)> {
        let all = self.content.signals.signals().into_iter();
        all.map(|(name, values)| {
            let unit = name.parse::<SignalName>().map_or("", |name| name.kind.dimension().si_unit());
            (name, unit, is_measured(values))
        })
        .collect()
    }

    /// One signal.
    fn column<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        columns::view(slf, |own| own.content.signals.signal(name)).ok_or_else(|| {
            let known: Vec<String> = slf.get().content.signals.signals().into_iter().map(|(name, _)| name).collect();
            PyKeyError::new_err(format!("no signal \"{name}\"; there are {}", known.join(", ")))
        })
    }

    /// The samples from `start` to `stop`, s after the first.
    fn part(&self, py: Python<'_>, start: Option<f64>, stop: Option<f64>) -> PyResult<Self> {
        let content = &self.content;
        let signals = py.detach(|| part(&content.signals, start, stop))?;
        Ok(Recording::of(Content { signals, report: content.report.clone(), is_mapped: content.is_mapped }))
    }

    /// Writes a bag.
    fn write(&self, py: Python<'_>, folder: PathBuf, namespace: &str, replace: bool) -> PyResult<()> {
        let options = WriteOptions { replace, ..WriteOptions::default() };
        let topics = Topics::in_namespace(namespace);
        py.detach(|| write_recording(&folder, &self.content.signals, &topics, &options)).map_err(of_bag)
    }
}

/// A part of a recording. Its source has the form that the program uses for parts.
fn part(whole: &Signals, start: Option<f64>, stop: Option<f64>) -> PyResult<Signals> {
    if start.is_none() && stop.is_none() {
        return Ok(whole.clone());
    }
    let name = Path::new(&whole.source);
    let wanted = Part::between(start.unwrap_or(0.0), stop.unwrap_or(f64::INFINITY), name).map_err(of_work)?;
    let mut part = wanted.of(whole, name).map_err(of_work)?;
    let shown = |time: Option<f64>| time.map_or(String::new(), |time| time.to_string());
    part.source = format!("{}@{}..{}", whole.source, shown(start), shown(stop));
    Ok(part)
}

/// Reads a recording: a bag or a table, with a map where it has names of its own.
#[pyfunction]
pub fn read(
    py: Python<'_>,
    path: PathBuf,
    map: Option<&Bound<'_, PyAny>>,
    namespace: Option<&str>,
    start: Option<f64>,
    stop: Option<f64>,
) -> PyResult<Recording> {
    let map = map.map(Map::of).transpose()?;
    py.detach(|| {
        let is_mapped = map.is_some() || TopicMap::beside(&path).is_some() || Table::is_table(&path);
        let (signals, report) = read_with(&path, map, namespace)?;
        let signals = if start.is_none() && stop.is_none() { signals } else { part(&signals, start, stop)? };
        Ok(Recording::of(Content { signals, report, is_mapped }))
    })
}

fn read_with(path: &Path, map: Option<Map>, namespace: Option<&str>) -> PyResult<(Signals, ReadReport)> {
    match map {
        Some(map @ Map::Table(_)) => read_mapped(path, &map.read()?).map_err(of_bag),
        Some(Map::File(map)) => read_recording_or_mapped(path, Origin { map: Some(&map), namespace }).map_err(of_bag),
        None => read_recording_or_mapped(path, Origin { map: None, namespace }).map_err(of_bag),
    }
}
