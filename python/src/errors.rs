//! The Python exceptions: one base class, and a subclass for each kind of error. The text is one line.

use excavator_bags::BagError;
use excavator_bags::map::MapError;
use excavator_model::document::DocumentError;
use excavator_study::WorkError;
use pyo3::exceptions::PyException;
use pyo3::{PyErr, create_exception};

create_exception!(excavator, ExcavatorError, PyException, "Something that excavator cannot do, in one line.");
create_exception!(excavator, ReadError, ExcavatorError, "A bag, table or map that cannot be read or written.");
create_exception!(excavator, ModelError, ExcavatorError, "A model, effect, formula or parameter that cannot be.");
create_exception!(
    excavator,
    CheckError,
    ExcavatorError,
    "A recording that a check refuses. `accept=[\"NAME\"]` with the name in the text overrules it."
);
create_exception!(excavator, ComputationError, ExcavatorError, "A computation that has no result.");

/// A bag or table that cannot be used.
pub fn of_bag(error: impl Into<BagError>) -> PyErr {
    let error: BagError = error.into();
    ReadError::new_err(error.to_string())
}

/// A map that cannot be used.
pub fn of_map(error: MapError) -> PyErr {
    ReadError::new_err(error.to_string())
}

/// A model text that cannot be used.
pub fn of_document(error: DocumentError) -> PyErr {
    ModelError::new_err(error.to_string())
}

/// A change that the model does not allow.
pub fn of_model(error: excavator_model::ModelError) -> PyErr {
    ModelError::new_err(error.to_string())
}

/// A verb that failed.
pub fn of_work(error: WorkError) -> PyErr {
    let text = error.to_string();
    match error {
        WorkError::Recording(_)
        | WorkError::Bag(_)
        | WorkError::Part { .. }
        | WorkError::DiagnosisSyntax { .. }
        | WorkError::StudySyntax { .. }
        | WorkError::SheetSyntax { .. }
        | WorkError::ValveTest { .. }
        | WorkError::PositionTest { .. }
        | WorkError::Unreadable { .. }
        | WorkError::MappedUnit(_)
        | WorkError::Changed { .. } => ReadError::new_err(text),
        WorkError::Check(refusal) => CheckError::new_err(match refusal.name() {
            Some(name) => format!("{text}; if this is right, say accept=[\"{name}\"]"),
            None => text,
        }),
        WorkError::Document(_)
        | WorkError::Model(_)
        | WorkError::Condition { .. }
        | WorkError::Profile(_)
        | WorkError::ProfileSyntax { .. }
        | WorkError::ProfileWrite(_)
        | WorkError::ProfileCylinder { .. } => ModelError::new_err(text),
        WorkError::Regression(_)
        | WorkError::Identify(_)
        | WorkError::Diagnosis(_)
        | WorkError::Design(_)
        | WorkError::Energy(_)
        | WorkError::Refine(_)
        | WorkError::Fit(_)
        | WorkError::Run(_)
        | WorkError::Signal(_)
        | WorkError::Json(_)
        | WorkError::Positioner(_)
        | WorkError::NoRecording
        | WorkError::NoTie { .. } => ComputationError::new_err(text),
    }
}
