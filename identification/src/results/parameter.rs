//! A parameter with its uncertainty.

use excavator_model::effects::Site;
use excavator_model::{Model, Parameter as ModelParameter};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::finite;
use crate::value_marks::value_mark;

/// A parameter of an effect, with its uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct Parameter {
    /// Contract name, `arm.inertia`; of a proposed law its name in the formula.
    pub name: String,
    /// Value, in `unit`.
    pub value: Option<f64>,
    /// Standard error of the value, in `unit`; `null` where there is none.
    pub std_error: Option<f64>,
    /// Half width of the 95 % interval, in `unit`; `null` where there is none.
    pub margin_95: Option<f64>,
    /// SI unit; `-` for a pure number.
    #[serde(default)]
    pub unit: String,
    /// Why the value is not to be taken as a property of the machine; absent where it can be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub remark: Option<String>,
}

impl Parameter {
    /// A parameter under this name.
    pub(super) fn named(name: &str, parameter: &ModelParameter) -> Self {
        Parameter {
            name: name.to_string(),
            value: finite(parameter.value),
            std_error: parameter.standard_error.and_then(finite),
            margin_95: parameter.margin_95.and_then(finite),
            unit: parameter.card.unit.to_string(),
            remark: None,
        }
    }

    /// The parameters of a model with these indices, in the model's order.
    pub(super) fn of(model: &Model, indices: &[usize]) -> Vec<Self> {
        let names = model.parameter_names();
        let chosen = model.parameters().enumerate().filter(|(index, _)| indices.contains(index));
        chosen
            .map(|(index, (_, parameter))| Parameter {
                remark: value_mark(model, index).map(|mark| mark.to_string()),
                ..Parameter::named(&names[index], parameter)
            })
            .collect()
    }

    /// Those that a model has of an effect at a site.
    pub(super) fn of_effect(model: &Model, name: &str, site: Site) -> Vec<Self> {
        let is_own = |effect: usize| model.effects[effect].is(name, site);
        let parameters = model.parameters().enumerate();
        let indices: Vec<usize> = parameters.filter(|(_, (effect, _))| is_own(*effect)).map(|one| one.0).collect();
        Parameter::of(model, &indices)
    }
}
