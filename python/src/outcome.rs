//! The result of a verb.

use std::sync::Arc;

use excavator_study::results::Outcome as Told;
use pyo3::prelude::*;

use crate::errors::of_work;
use crate::model::Model;
use crate::recording::Recording;

/// The result of a verb.
#[pyclass(frozen, module = "excavator._native")]
pub struct Outcome {
    told: Arc<dyn Told>,
}

impl Outcome {
    /// Wraps the result of a verb.
    pub fn of(told: Arc<dyn Told>) -> Self {
        Outcome { told }
    }
}

#[pymethods]
impl Outcome {
    /// The content of `--json`.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| self.told.json()).map_err(of_work)
    }

    /// The result in a sentence or two.
    fn sentence(&self, py: Python<'_>) -> String {
        py.detach(|| self.told.sentence())
    }

    /// The page of `--report`, for verbs that have one.
    fn page(&self, py: Python<'_>) -> PyResult<Option<String>> {
        py.detach(|| self.told.page()).map_err(of_work)
    }

    /// The model that was found, for verbs that look for one.
    fn model(&self) -> Option<Model> {
        self.told.model().cloned().map(Model::of)
    }

    /// The file beside the report, for verbs that write one.
    fn file(&self) -> PyResult<Option<String>> {
        self.told.file().map_err(of_work)
    }

    /// Signals over time that belong to the result.
    fn recordings(&self) -> Vec<(&'static str, Recording)> {
        let all = self.told.recordings().into_iter();
        all.map(|(what, signals)| (what, Recording::of_signals(signals.clone()))).collect()
    }
}
