//! The Python package `excavator`: thin classes over the crates of the workspace.
//!
//! The public API is written in Python, in `excavator/`. This library is its part `excavator._native`. Long work releases the
//! lock of the interpreter and can be interrupted, see [`work`].

mod bag;
mod columns;
mod errors;
mod json;
mod mapping;
mod model;
mod outcome;
mod recording;
mod store;
mod topic_columns;
mod verbs;
mod work;

use pyo3::prelude::*;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::bag::Bag;
    #[pymodule_export]
    use crate::errors::{CheckError, ComputationError, ExcavatorError, ModelError, ReadError};
    #[pymodule_export]
    use crate::json::to_toml;
    #[pymodule_export]
    use crate::mapping::guess_map;
    #[pymodule_export]
    use crate::model::Model;
    #[pymodule_export]
    use crate::outcome::Outcome;
    #[pymodule_export]
    use crate::recording::{Recording, read};
    #[pymodule_export]
    use crate::store::{
        StoreError, store_fingerprint, store_get, store_list, store_put, store_put_if_absent, store_thin_copy,
    };
    #[pymodule_export]
    use crate::verbs::{characterise, compare, design, diagnose, energy, identify, propose, refine, simulate};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
