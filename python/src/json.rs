//! Converts JSON between Rust and Python.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::Value;

/// A Python value as JSON, converted by Python's module `json`.
pub fn from_python(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let text: String = value.py().import("json")?.call_method1("dumps", (value,))?.extract()?;
    serde_json::from_str(&text).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// A `dict` of Python as TOML.
#[pyfunction]
pub fn to_toml(value: &Bound<'_, PyAny>) -> PyResult<String> {
    toml::to_string(&from_python(value)?).map_err(|error| PyValueError::new_err(error.to_string()))
}
