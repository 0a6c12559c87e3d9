//! The verbs of the program as functions.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use excavator_identification::identify::Method;
use excavator_identification::refinement::Additions;
use excavator_model::Model as Physics;
use excavator_model::recording::Recording as Signals;
use excavator_study::diagnosis_file::DiagnosisFile;
use excavator_study::recordings::{Use, checked, most_informative};
use excavator_study::results::{DesignOrder, Determined, Outcome as Told, Progress, Separated};
use excavator_study::{Study, WorkError};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::model::Model;
use crate::outcome::Outcome;
use crate::recording::{Content, Recording};
use crate::work;

/// How recordings are used.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Usage {
    accept: Vec<String>,
    conditions: Vec<String>,
    whole: bool,
}

/// Prepares recordings for use, and collects the remarks on them.
struct Desk {
    usage: Usage,
    remarks: Vec<String>,
}

impl Desk {
    fn new(usage: Usage) -> Self {
        Desk { usage, remarks: Vec::new() }
    }

    /// Checks a recording.
    fn checked(&mut self, content: &Content, model: &Physics) -> Result<Signals, WorkError> {
        self.as_used(content.signals.clone(), content, model)
    }

    /// Checks a recording. Of a long one, uses the most informative stretches.
    fn most_informative(&mut self, content: &Content, model: &Physics) -> Result<Signals, WorkError> {
        let whole = &content.signals;
        let part = if self.usage.whole { None } else { most_informative(whole, content.is_mapped, model)? };
        let Some((part, choice)) = part else { return self.as_used(whole.clone(), content, model) };
        self.remarks.push(format!("{}: {choice}; whole=True uses all", whole.source));
        self.as_used(part, content, model)
    }

    fn as_used(&mut self, signals: Signals, content: &Content, model: &Physics) -> Result<Signals, WorkError> {
        let usage = Use { accept: &self.usage.accept, conditions: &self.usage.conditions, ..Use::default() };
        checked(&content.signals.source, signals, &content.report, &usage, model, &mut self.remarks)
    }

    fn all(&mut self, contents: &[Arc<Content>], model: &Physics) -> Result<Vec<Signals>, WorkError> {
        contents.iter().map(|content| self.most_informative(content, model)).collect()
    }

    /// A study of the recordings for the fit and of those for validation.
    fn study(&mut self, contents: &[Vec<Arc<Content>>; 2], model: &Physics) -> Result<Study, WorkError> {
        let mut study = Study::new(model.clone(), self.all(&contents[0], model)?, self.all(&contents[1], model)?);
        for content in contents.iter().flatten() {
            let lost = content.report.lost_of_sources();
            study.lost_messages.extend(lost.iter().map(|line| format!("{}: {line}", content.signals.source)));
        }
        self.remarks.extend(study.shared_readings(&self.usage.accept)?);
        Ok(study)
    }
}

/// Runs a verb. Returns its result and the remarks on its recordings.
fn done<T: Told + 'static>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    usage: Usage,
    verb: impl FnOnce(&mut Desk, Progress<'_>) -> Result<T, WorkError> + Send + 'static,
) -> PyResult<(Outcome, Vec<String>)> {
    let found = work::run(py, progress, move |progress| {
        let mut desk = Desk::new(usage);
        let found = verb(&mut desk, progress)?;
        Ok((Arc::new(found) as Arc<dyn Told>, desk.remarks))
    })?;
    Ok((Outcome::of(found.0), found.1))
}

fn contents(recordings: &[PyRef<'_, Recording>]) -> Vec<Arc<Content>> {
    recordings.iter().map(|recording| recording.content()).collect()
}

/// `compare`.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    model: &Model,
    recording: &Recording,
    against: Option<&Model>,
    repeat: Option<&Recording>,
    usage: Usage,
) -> PyResult<(Outcome, Vec<String>)> {
    let (model, against) = (model.physics(), against.map(Model::physics));
    let (recording, repeat) = (recording.content(), repeat.map(Recording::content));
    done(py, None, usage, move |desk, _| {
        let used = desk.most_informative(&recording, &model)?;
        let again = repeat.map(|repeat| desk.checked(&repeat, &model)).transpose()?;
        Study::of_recording((*model).clone(), used).compare(against.as_deref(), again.as_ref())
    })
}

/// `identify`.
#[pyfunction]
pub fn identify(
    py: Python<'_>,
    model: &Model,
    recordings: Vec<PyRef<'_, Recording>>,
    method: &str,
    usage: Usage,
) -> PyResult<(Outcome, Vec<String>)> {
    let method = match method {
        "best" => Method::Best,
        "weak-form" => Method::WeakForm,
        "least-squares" => Method::LeastSquares,
        "output-error" => Method::OutputError,
        "simulation-error" => Method::SimulationError,
        other => {
            let known = "best, weak-form, least-squares, output-error, simulation-error";
            return Err(PyValueError::new_err(format!("no method \"{other}\"; there are {known}")));
        }
    };
    let (model, recordings) = (model.physics(), contents(&recordings));
    done(py, None, usage, move |desk, _| {
        let used = desk.all(&recordings, &model)?;
        Study::of_fitted((*model).clone(), used).identify(method, &|_| ControlFlow::Continue(()))
    })
}

/// `characterise`.
#[pyfunction]
pub fn characterise(
    py: Python<'_>,
    model: &Model,
    recordings: Vec<PyRef<'_, Recording>>,
    usage: Usage,
) -> PyResult<(Outcome, Vec<String>)> {
    let (model, recordings) = (model.physics(), contents(&recordings));
    done(py, None, usage, move |desk, _| {
        let used = recordings.iter().map(|content| desk.checked(content, &model)).collect::<Result<Vec<_>, _>>()?;
        Ok(Study::of_fitted((*model).clone(), used).characterise())
    })
}

/// `energy`.
#[pyfunction]
pub fn energy(py: Python<'_>, model: &Model, recording: &Recording, usage: Usage) -> PyResult<(Outcome, Vec<String>)> {
    let (model, recording) = (model.physics(), recording.content());
    done(py, None, usage, move |desk, _| match recording.is_mapped {
        true => Study::of_recording((*model).clone(), desk.checked(&recording, &model)?).energy(),
        false => Study::of_recording((*model).clone(), recording.signals.clone()).energy_in_blocks(),
    })
}

/// `diagnose`.
#[pyfunction]
pub fn diagnose(
    py: Python<'_>,
    model: &Model,
    identification: Vec<PyRef<'_, Recording>>,
    validation: Vec<PyRef<'_, Recording>>,
    usage: Usage,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Outcome, Vec<String>)> {
    let (model, both) = (model.physics(), [contents(&identification), contents(&validation)]);
    done(py, progress, usage, move |desk, progress| desk.study(&both, &model)?.diagnose(progress))
}

/// `propose`.
#[pyfunction]
pub fn propose(
    py: Python<'_>,
    model: &Model,
    identification: Vec<PyRef<'_, Recording>>,
    validation: Vec<PyRef<'_, Recording>>,
    usage: Usage,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Outcome, Vec<String>)> {
    let (model, both) = (model.physics(), [contents(&identification), contents(&validation)]);
    done(py, progress, usage, move |desk, progress| desk.study(&both, &model)?.propose(progress))
}

/// `refine`: with these effects, or without names with what a diagnosis finds (and with laws that are proposed).
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub fn refine(
    py: Python<'_>,
    model: &Model,
    identification: Vec<PyRef<'_, Recording>>,
    validation: Vec<PyRef<'_, Recording>>,
    add: Vec<String>,
    with_laws: bool,
    usage: Usage,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(Outcome, Vec<String>)> {
    let (model, both) = (model.physics(), [contents(&identification), contents(&validation)]);
    done(py, progress, usage, move |desk, progress| {
        let additions = match (add.as_slice(), with_laws) {
            ([], true) => Additions::AutoWithLaws,
            ([], false) => Additions::Auto,
            (names, _) => Additions::named(&model, names)?,
        };
        desk.study(&both, &model)?.refine(&additions, progress)
    })
}

/// What a design is for, and what it must keep to.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Order {
    between: Vec<String>,
    parameter: Option<String>,
    /// A file of `diagnose --json`, or its text.
    diagnosis_file: Option<PathBuf>,
    diagnosis_text: Option<String>,
    duration: f64,
    stroke_margin: f64,
    highest_pressure: f64,
}

/// `design`.
#[pyfunction]
pub fn design(py: Python<'_>, model: &Model, order: Order, progress: Option<&Bound<'_, PyAny>>) -> PyResult<Outcome> {
    let model = model.physics();
    let found = work::run(py, progress, move |progress| {
        let Order { between, parameter, diagnosis_file, diagnosis_text, duration, stroke_margin, highest_pressure } =
            order;
        let diagnosis = match (&diagnosis_file, &diagnosis_text) {
            (Some(path), _) => Some(DiagnosisFile::read(path)?),
            (None, Some(text)) => Some(DiagnosisFile::of_text(Path::new("the diagnosis"), text)?),
            (None, None) => None,
        };
        let order = DesignOrder { between, duration, stroke_margin, highest_pressure };
        Ok(match parameter {
            Some(name) => {
                Arc::new(Determined::of(&model, &name, &order, diagnosis.as_ref(), progress)?) as Arc<dyn Told>
            }
            None => Arc::new(Separated::of(&model, &order, diagnosis.as_ref(), progress)?) as Arc<dyn Told>,
        })
    })?;
    Ok(Outcome::of(found))
}

/// `simulate` with the inputs of a recording.
#[pyfunction]
pub fn simulate(
    py: Python<'_>,
    model: &Model,
    recording: &Recording,
    usage: Usage,
) -> PyResult<(Recording, Vec<String>)> {
    let (model, recording) = (model.physics(), recording.content());
    let (simulated, remarks) = work::run(py, None, move |_| {
        let mut desk = Desk::new(usage);
        let used = desk.checked(&recording, &model)?;
        Ok((excavator_model::simulation::simulate(&model, &used)?, desk.remarks))
    })?;
    Ok((Recording::of_signals(simulated), remarks))
}
