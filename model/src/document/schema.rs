//! JSON schema of the model file, for editors: derived from the types that read it, with the effects and parameters of a catalogue.

use std::collections::BTreeMap;

use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

use super::model_text::ModelText;
use super::{BUILT_IN, built_in};
use crate::effects::{AnyEffect, Catalogue, ParameterCard};
use crate::template::examples;

/// Effects that models may have, with their parameters wherever they differ from machine to machine.
pub(super) struct EffectForm {
    /// The effect.
    pub effect: AnyEffect,
    /// Cards of its parameters, by name; several where the unit depends on the machine.
    pub parameters: BTreeMap<String, Vec<ParameterCard>>,
}

/// The JSON schema (draft 2020-12) of a model file whose effects are those of `catalogue`, or formulas of its own.
pub fn schema(catalogue: &Catalogue) -> Value {
    let generator = SchemaSettings::draft2020_12().with(|settings| settings.inline_subschemas = true).into_generator();
    let mut schema = Value::from(generator.into_root_schema_for::<ModelText>());
    schema["title"] = json!("Model file of excavator");
    let effects: Vec<Value> = effect_forms(catalogue).iter().map(when_named).collect();
    let names: Vec<&str> = catalogue.iter().map(|effect| &*effect.card().name).collect();
    if let Some(item) = schema.pointer_mut("/properties/effects/items") {
        item["properties"]["effect"]["examples"] = json!(names);
        item["allOf"] = Value::Array(effects);
    }
    schema
}

/// What an entry of `[[effects]]` may hold once its effect is known.
fn when_named(form: &EffectForm) -> Value {
    let card = form.effect.card();
    let parameters: Map<String, Value> = form
        .parameters
        .iter()
        .map(|(name, cards)| {
            let mut units: Vec<&str> = cards.iter().map(|card| &*card.unit).collect();
            units.dedup();
            (name.clone(), json!({ "description": cards[0].meaning, "properties": { "unit": { "enum": units } } }))
        })
        .collect();
    json!({
        "if": { "properties": { "effect": { "const": card.name } }, "required": ["effect"] },
        "then": {
            "description": card.summary,
            "properties": {
                "parameters": { "properties": parameters, "propertyNames": { "enum": form.parameters.keys().collect::<Vec<_>>() } },
            },
        },
    })
}

/// Every effect of `catalogue` with its parameters at all places of the built-in machines and of those that templates make.
pub(super) fn effect_forms(catalogue: &Catalogue) -> Vec<EffectForm> {
    let models: Vec<_> = BUILT_IN.iter().filter_map(|(name, _)| built_in(name).ok()).chain(examples()).collect();
    let form = |effect: &AnyEffect| {
        let mut parameters: BTreeMap<String, Vec<ParameterCard>> = BTreeMap::new();
        for model in &models {
            let bare = crate::Model { effects: Vec::new(), ..model.clone() };
            for site in bare.free_sites(effect) {
                for card in effect.parameters(&model.machine, site) {
                    let card = card.for_place(&model.machine, site);
                    let known = parameters.entry(card.name.to_string()).or_default();
                    if known.iter().all(|other| other.unit != card.unit) {
                        known.push(card);
                    }
                }
            }
        }
        EffectForm { effect: effect.clone(), parameters }
    };
    catalogue.iter().map(form).collect()
}
