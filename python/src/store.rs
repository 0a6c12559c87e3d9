//! Object storage for `excavator.fleet`.

use std::path::PathBuf;

use excavator_store as store;
use excavator_store::Options;
use pyo3::create_exception;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::errors::{ExcavatorError, ReadError};

create_exception!(
    excavator,
    StoreError,
    ExcavatorError,
    "A store or a network that failed: the same may succeed later."
);

/// Converts an error: [`StoreError`] if another attempt may succeed, else `ReadError`.
fn of_store(error: store::StoreError) -> PyErr {
    let text = error.to_string();
    if error.is_passing() { StoreError::new_err(text) } else { ReadError::new_err(text) }
}

/// An object: address, size in bytes, the store's identifier of the content, and the time of the last write in ns since the
/// epoch.
type Row = (String, u64, Option<String>, i64);

/// A copy: path, bytes read, bytes of the bag, messages, and files copied whole with the reason.
type Copied = (PathBuf, u64, u64, u64, Vec<String>);

/// The content of an object.
#[pyfunction]
pub fn store_get<'py>(py: Python<'py>, url: &str, options: Options) -> PyResult<Bound<'py, PyBytes>> {
    let content = py.detach(|| store::get(url, &options)).map_err(of_store)?;
    Ok(PyBytes::new(py, &content))
}

/// Writes an object, or replaces it.
#[pyfunction]
pub fn store_put(py: Python<'_>, url: &str, content: Vec<u8>, options: Options) -> PyResult<()> {
    py.detach(|| store::put(url, &content, &options)).map_err(of_store)
}

/// Writes an object only where there is none; says whether it did.
#[pyfunction]
pub fn store_put_if_absent(py: Python<'_>, url: &str, content: Vec<u8>, options: Options) -> PyResult<bool> {
    py.detach(|| store::put_if_absent(url, &content, &options)).map_err(of_store)
}

/// All objects below a folder, by address.
#[pyfunction]
pub fn store_list(py: Python<'_>, url: &str, options: Options) -> PyResult<Vec<Row>> {
    let found = py.detach(|| store::list(url, &options)).map_err(of_store)?;
    Ok(found.into_iter().map(|one| (one.url, one.size, one.etag, one.last_modified)).collect())
}

/// Identity of the content at an address.
#[pyfunction]
pub fn store_fingerprint(py: Python<'_>, url: &str, options: Options) -> PyResult<String> {
    py.detach(|| store::fingerprint(url, &options)).map_err(of_store)
}

/// Copies the bag at an address into a folder, with only the wanted topics.
#[pyfunction]
pub fn store_thin_copy(
    py: Python<'_>,
    url: &str,
    topics: Option<Vec<String>>,
    target: PathBuf,
    options: Options,
) -> PyResult<Copied> {
    let done = py.detach(|| store::thin_copy(url, topics.as_deref(), &target, &options)).map_err(of_store)?;
    Ok((done.path, done.bytes_read, done.bytes_total, done.messages, done.whole))
}
