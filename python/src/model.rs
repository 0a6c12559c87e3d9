//! Models: a machine and its effects.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use excavator_model::document::{BUILT_IN, parse, parse_catalogue, to_text};
use excavator_model::effects::{Catalogue, Site};
use excavator_model::template::examples;
use excavator_model::{Model as Physics, site_name, site_named};
use excavator_study::model_named;
use excavator_study::profile_file::ProfileFile;
use excavator_study::simulated::{simulate_commands, simulate_profile};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use rosbag2::{ReadLimits, read_regular_text};

use crate::errors::{ModelError, of_bag, of_document, of_model, of_work};
use crate::recording::Recording;
use crate::{json, work};

/// A parameter: value, unit, known, standard error, margin of 95 %, meaning, source, least and largest plausible value.
type ParameterRow = (f64, String, bool, Option<f64>, Option<f64>, String, String, f64, f64);

/// A machine plus a list of physical effects.
#[pyclass(frozen, module = "excavator._native")]
pub struct Model {
    physics: Arc<Physics>,
}

impl Model {
    /// Wraps a model.
    pub fn of(physics: Physics) -> Self {
        Model { physics: Arc::new(physics) }
    }

    /// The model, for work without the lock of the interpreter.
    pub fn physics(&self) -> Arc<Physics> {
        self.physics.clone()
    }

    /// The sites that a name refers to: `EFFECT@PLACE`, or `EFFECT` for every place that has it.
    fn places(&self, name: &str) -> PyResult<Vec<(String, Site)>> {
        let (effect, place) = name.split_once('@').map_or((name, None), |(effect, place)| (effect, Some(place)));
        let wanted = place.map(|place| site_named(&self.physics.machine, place));
        let fits = |site: Site| wanted.is_none_or(|wanted| wanted == Some(site));
        let own = self.physics.effects.iter().filter(|one| one.name() == effect && fits(one.site));
        let found: Vec<(String, Site)> = own.map(|one| (effect.to_string(), one.site)).collect();
        if found.is_empty() {
            let machine = &self.physics.machine;
            let names =
                self.physics.effects.iter().map(|one| format!("{}@{}", one.name(), site_name(machine, one.site)));
            let known = names.collect::<Vec<_>>().join(", ");
            return Err(ModelError::new_err(format!("{} has no effect {name}; it has {known}", machine.name)));
        }
        Ok(found)
    }
}

/// Wraps a model, if its values are valid: its text must be readable again.
fn possible(physics: Physics) -> PyResult<Model> {
    to_text(&physics).map_err(of_document)?;
    Ok(Model::of(physics))
}

#[pymethods]
impl Model {
    /// A built-in model, or one from a file.
    #[staticmethod]
    fn load(name: PathBuf) -> PyResult<Self> {
        model_named(&name.display().to_string(), &Catalogue::built_in()).map(Model::of).map_err(of_work)
    }

    /// From the text of a model file.
    #[staticmethod]
    fn from_toml(text: &str, name: &str) -> PyResult<Self> {
        parse(name, text, &Catalogue::built_in()).map(Model::of).map_err(of_document)
    }

    /// Names of the built-in models.
    #[staticmethod]
    fn built_in() -> Vec<&'static str> {
        BUILT_IN.iter().map(|(name, _)| *name).collect()
    }

    /// Models from example data sheets, one for each kind of machine.
    #[staticmethod]
    fn templates() -> Vec<(String, Model)> {
        examples().into_iter().map(|model| (model.machine.name.clone(), Model::of(model))).collect()
    }

    /// Name of the machine.
    #[getter]
    fn name(&self) -> &str {
        &self.physics.machine.name
    }

    /// What the machine is.
    #[getter]
    fn description(&self) -> &str {
        &self.physics.machine.description
    }

    /// Names of the cylinders.
    #[getter]
    fn cylinders(&self) -> Vec<String> {
        self.physics.machine.cylinders.iter().map(|cylinder| cylinder.name.clone()).collect()
    }

    /// Name, place, summary and equation of each effect.
    fn effects(&self) -> Vec<(String, String, String, String)> {
        let machine = &self.physics.machine;
        let one = |effect: &excavator_model::ModelEffect| {
            let card = effect.physics.card();
            let place = site_name(machine, effect.site).to_string();
            (card.name.to_string(), place, card.summary.to_string(), card.equation.to_string())
        };
        self.physics.effects.iter().map(one).collect()
    }

    /// Name and summary of each effect that the model may have.
    fn catalogue(&self) -> Vec<(String, String)> {
        self.physics
            .catalogue
            .iter()
            .map(|effect| (effect.card().name.to_string(), effect.card().summary.to_string()))
            .collect()
    }

    /// Each parameter by name, with the name of its effect.
    fn parameters(&self) -> Vec<(String, String, ParameterRow)> {
        let names = self.physics.parameter_names().into_iter();
        names
            .zip(self.physics.parameters())
            .map(|(name, (effect, parameter))| {
                let card = &parameter.card;
                let row = (
                    parameter.value,
                    card.unit.to_string(),
                    parameter.known,
                    parameter.standard_error,
                    parameter.margin_95,
                    card.meaning.to_string(),
                    parameter.source.clone(),
                    card.minimum,
                    card.maximum,
                );
                (name, self.physics.effects[effect].name().to_string(), row)
            })
            .collect()
    }

    /// What was done to the model: when and what.
    fn history(&self) -> Vec<(String, String)> {
        self.physics.history.iter().map(|entry| (entry.when.clone(), entry.what.clone())).collect()
    }

    /// With formulas of a catalogue file (text) among the effects that it may have.
    fn with_catalogue(&self, text: &str, name: &str) -> PyResult<Self> {
        let catalogue = parse_catalogue(name, text, &self.physics.catalogue).map_err(of_document)?;
        Ok(Model::of(Physics { catalogue, ..(*self.physics).clone() }))
    }

    /// With one more effect, wherever the name says, at its start values.
    fn with_effect(&self, name: &str) -> PyResult<Self> {
        let mut physics = (*self.physics).clone();
        for (effect, site) in self.physics.parse_addition(name).map_err(of_model)? {
            physics = physics.with_effect(&effect, site).map_err(of_model)?;
        }
        Ok(Model::of(physics))
    }

    /// Without an effect.
    fn without_effect(&self, name: &str) -> PyResult<Self> {
        let gone = self.places(name)?;
        let mut physics = (*self.physics).clone();
        physics.effects.retain(|one| !gone.iter().any(|(effect, site)| one.is(effect, *site)));
        possible(physics)
    }

    /// With another value of a parameter, in its SI unit.
    #[pyo3(signature = (name, value, known, source))]
    fn with_value(&self, name: &str, value: f64, known: Option<bool>, source: Option<String>) -> PyResult<Self> {
        let names = self.physics.parameter_names();
        let Some(index) = names.iter().position(|one| one == name) else {
            let text =
                format!("{} has no parameter \"{name}\"; it has {}", self.physics.machine.name, names.join(", "));
            return Err(PyKeyError::new_err(text));
        };
        let mut physics = (*self.physics).clone();
        if let Some(parameter) = physics.parameters_mut().nth(index) {
            parameter.value = value;
            parameter.known = known.unwrap_or(parameter.known);
            parameter.standard_error = None;
            parameter.margin_95 = None;
            parameter.source = source.unwrap_or_default();
        }
        possible(physics)
    }

    /// The text of a model file.
    fn to_toml(&self) -> PyResult<String> {
        to_text(&self.physics).map_err(of_document)
    }

    /// Simulates a profile: a file (TOML), or the same content as a `dict`.
    fn simulate_profile(&self, py: Python<'_>, profile: &Bound<'_, PyAny>) -> PyResult<Recording> {
        let physics = self.physics();
        let file = profile.extract::<PathBuf>().ok();
        let path = file.clone().unwrap_or_else(|| PathBuf::from("profile"));
        let text = match &file {
            Some(path) => read_regular_text(path, ReadLimits::DEFAULT.document).map_err(of_bag)?,
            None => {
                let table = json::from_python(profile)?;
                toml::to_string(&table).map_err(|error| ModelError::new_err(error.to_string()))?
            }
        };
        let simulated = work::run(py, None, move |_| {
            let file = ProfileFile::of_text(&path, &text, &physics.machine)?;
            simulate_profile(&physics, &file, &path)
        })?;
        Ok(Recording::of_signals(simulated))
    }

    /// Simulates commands from rest at the given displacements, m from mid-stroke.
    fn simulate_commands(
        &self,
        py: Python<'_>,
        commands: &Recording,
        start: BTreeMap<String, f64>,
    ) -> PyResult<Recording> {
        let (physics, content) = (self.physics(), commands.content());
        let simulated = work::run(py, None, move |_| {
            simulate_commands(&physics, content.signals.clone(), &start, Path::new(&content.signals.source))
        })?;
        Ok(Recording::of_signals(simulated))
    }
}
