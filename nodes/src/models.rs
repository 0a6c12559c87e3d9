//! The model of a node: from its parameter, or from the topic of models.

use excavator_model::Model;
use excavator_model::effects::Catalogue;
use excavator_ros::{Parameter, Parameters, Value};
use excavator_study::{WorkError, model_named};

/// The parameter that names a node's model, if the node does not use the published one.
pub(crate) fn model_parameter() -> Parameter {
    let meaning = "built-in model or model file (.toml); empty: the model on arm/model";
    Parameter::new("model", Value::String(String::new()), meaning).read_only()
}

/// The model that a node's parameter names; `None` if it names none.
///
/// # Errors
/// [`WorkError`] for an unknown name or a faulty file.
pub(crate) fn chosen_model(parameters: &Parameters) -> Result<Option<Model>, WorkError> {
    let name = parameters.text("model");
    if name.is_empty() { Ok(None) } else { model_named(&name, &Catalogue::built_in()).map(Some) }
}
