//! A model file: machine, effects, history.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::catalogue_text::with_formulas;
use super::machine_text::MachineText;
use super::{DocumentError, TomlFault, toml_fault};
use crate::effects::{Catalogue, Kind, ParameterCard};
use crate::formula::FormulaText;
use crate::model::{site_name, site_named};
use crate::{HistoryEntry, Model, ModelEffect};

/// A model: a machine and a list of physical effects. Numbers are in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct ModelText {
    /// Version of the form of the file; files without it are of the first one.
    #[serde(default = "first_format")]
    format: u32,
    /// The machine.
    machine: MachineText,
    /// Formula effects that the model brings along.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    formula: Vec<FormulaText>,
    /// The physical effects, in the order in which they act.
    #[serde(default)]
    effects: Vec<EffectText>,
    /// What was done with the model, oldest first; written by `refine`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    history: Vec<HistoryEntry>,
}

/// A physical effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct EffectText {
    /// Its name: of the program, of a catalogue file, or of a formula in this file.
    effect: String,
    /// A cylinder's name, "pump" or "machine".
    at: String,
    /// Its parameters by name.
    #[serde(default)]
    parameters: BTreeMap<String, ParameterText>,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct ParameterText {
    /// Its value; of what is to be identified, where the search begins.
    value: f64,
    /// Its SI unit, "-" for a pure number.
    unit: String,
    /// Whether it is known, and a fit leaves it alone.
    #[serde(default)]
    known: bool,
    /// Standard error of an identified value; written by `identify` and `refine`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    standard_error: Option<f64>,
    /// Half the width of the 95 % interval of an identified value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    margin_95: Option<f64>,
    /// Where the number comes from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    source: String,
}

/// The form of model files that is written: the first one had no formulas.
const FORMAT: u32 = 2;

fn first_format() -> u32 {
    1
}

/// Reads a model from its text. It may have the effects of `catalogue` and those that its own text brings along. `name` is the file's or the built-in model's, for messages.
///
/// # Errors
/// [`DocumentError`] in one line that says which number is wrong.
pub fn parse(name: &str, text: &str, catalogue: &Catalogue) -> Result<Model, DocumentError> {
    let parsed: ModelText = toml::from_str(text).map_err(|error| {
        let TomlFault { message, excerpt } = toml_fault(text, &error);
        DocumentError::Syntax { name: name.to_string(), reason: message, excerpt }
    })?;
    if parsed.format > FORMAT {
        return Err(DocumentError::Inconsistent {
            name: name.to_string(),
            reason: format!("format {} is newer than this program, which reads up to {FORMAT}", parsed.format),
        });
    }
    let machine = parsed.machine.machine(name)?;
    let catalogue = with_formulas(name, catalogue, &parsed.formula)?;
    let mut model = Model {
        machine,
        effects: Vec::new(),
        history: parsed.history,
        catalogue: catalogue.clone(),
        imposed: crate::Imposed::Nothing,
    };
    for effect in &parsed.effects {
        let inconsistent = |reason: String| DocumentError::Inconsistent { name: name.to_string(), reason };
        let physics = catalogue.find(&effect.effect).map_err(|error| inconsistent(error.to_string()))?;
        let site = site_named(&model.machine, &effect.at).ok_or_else(|| {
            inconsistent(format!(
                "effect {} is at \"{}\", which is no cylinder, pump or machine",
                effect.effect, effect.at
            ))
        })?;
        model = model.with_effect(&physics, site).map_err(|error| inconsistent(error.to_string()))?;
        if let Some(added) = model.effects.last_mut() {
            fill_parameters(name, effect, added)?;
        }
    }
    Ok(model)
}

fn fill_parameters(name: &str, text: &EffectText, effect: &mut ModelEffect) -> Result<(), DocumentError> {
    let problem = |problem: String| DocumentError::Parameter {
        name: name.to_string(),
        effect: format!("{}@{}", text.effect, text.at),
        problem,
    };
    for wanted in text.parameters.keys() {
        if !effect.parameters.iter().any(|parameter| parameter.card.name == *wanted) {
            let names: Vec<&str> = effect.parameters.iter().map(|parameter| &*parameter.card.name).collect();
            return Err(problem(format!("has no parameter {wanted}; its parameters are {}", names.join(", "))));
        }
    }
    for parameter in &mut effect.parameters {
        let card = parameter.card.clone();
        let Some(given) = text.parameters.get(&*card.name) else {
            let left_out = effect.physics.value_where_left_out(&card.name);
            parameter.value = left_out.ok_or_else(|| problem(format!("lacks {}", card.name)))?;
            parameter.known = true;
            continue;
        };
        if given.unit != card.unit {
            return Err(DocumentError::WrongUnit {
                name: name.to_string(),
                quantity: format!("{}.{}", text.at, card.name),
                found: given.unit.clone(),
                expected: card.unit.to_string(),
            });
        }
        if let Some(must) = what_it_must_be(given, &card) {
            return Err(DocumentError::Impossible {
                name: name.to_string(),
                quantity: format!("{}.{}", text.at, card.name),
                value: given.value,
                must,
            });
        }
        parameter.value = given.value;
        parameter.known = given.known;
        parameter.standard_error = given.standard_error;
        parameter.margin_95 = given.margin_95;
        parameter.source.clone_from(&given.source);
    }
    Ok(())
}

/// What a given number must be and is not. What is to be identified is only a start, and may come out of a fit at the wrong side of
/// zero; what is known is used as it is, and the bounds of a search are none for it.
fn what_it_must_be(given: &ParameterText, card: &ParameterCard) -> Option<String> {
    let divides = card.kind == Kind::Reciprocal || card.minimum > 0.0;
    if !given.value.is_finite() {
        Some("a finite number".into())
    } else if divides && given.value <= 0.0 {
        Some("positive".into())
    } else if given.known && card.minimum >= 0.0 && given.value < 0.0 {
        Some("zero or positive where it is known".into())
    } else {
        None
    }
}

/// The text of a model. Sources of the machine's constants are not kept; its name says where to look them up.
///
/// # Errors
/// [`DocumentError`] when the text could not be read again: a number that cannot be written, or is impossible.
pub fn to_text(model: &Model) -> Result<String, DocumentError> {
    let formulas = model.effects.iter().filter_map(|effect| effect.physics.formula());
    let mut formula: Vec<FormulaText> = Vec::new();
    for text in formulas {
        // An effect at several places is written once.
        if !formula.contains(text) {
            formula.push(text.clone());
        }
    }
    let text = ModelText {
        format: FORMAT,
        formula,
        machine: MachineText::of(&model.machine),
        effects: model
            .effects
            .iter()
            .map(|effect| EffectText {
                effect: effect.name().to_string(),
                at: site_name(&model.machine, effect.site).to_string(),
                parameters: effect
                    .parameters
                    .iter()
                    .map(|parameter| {
                        let text = ParameterText {
                            value: parameter.value,
                            unit: parameter.card.unit.to_string(),
                            known: parameter.known,
                            standard_error: parameter.standard_error,
                            margin_95: parameter.margin_95,
                            source: parameter.source.clone(),
                        };
                        (parameter.card.name.to_string(), text)
                    })
                    .collect(),
            })
            .collect(),
        history: model.history.clone(),
    };
    let text = toml::to_string(&text).map_err(|error| DocumentError::Syntax {
        name: model.machine.name.clone(),
        reason: error.to_string(),
        excerpt: String::new(),
    })?;
    // A file that cannot be read again is worse than none.
    parse(&model.machine.name, &text, &model.catalogue)?;
    Ok(text)
}
