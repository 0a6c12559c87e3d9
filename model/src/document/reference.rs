//! Reference page of the model file, written from its schema: every table, every key.

use std::fmt::Write;

use serde_json::Value;

use super::schema;
use super::schema::{EffectForm, effect_forms};
use crate::effects::Catalogue;

/// The reference page, Markdown.
pub fn reference(catalogue: &Catalogue) -> String {
    let mut page = String::from(HEAD);
    let root = schema(catalogue);
    table(&mut page, "", &root);
    page.push_str(EFFECTS);
    for form in effect_forms(catalogue) {
        effect(&mut page, &form);
    }
    page
}

const HEAD: &str = "\
# The model file

A model is a machine plus a list of physical effects, in one TOML file. This page is written by `excavator model reference` from the
code that reads the file. `excavator model schema` writes the same as a JSON schema, which is also
`config/model.schema.json`: an editor that knows TOML completes and checks with it. `excavator model
check FILE` reads a file, tries the machine, and tells what is odd about its numbers.

A constant with a unit is `{ value = 0.5, unit = \"m\", source = \"drawing 12\" }`. The unit must be the one of this page; `source` may be
left out. Pressures are gauge.
";

const EFFECTS: &str = "
## Effects and their parameters

What may stand in `effect`, beside the names of formulas. `excavator effects NAME` describes one in full.

| effect | parameter | unit | meaning |
|---|---|---|---|
";

/// One table of the file with all tables below it.
fn table(page: &mut String, path: &str, schema: &Value) {
    let shown = if path.is_empty() { "The file".to_string() } else { format!("`{path}`") };
    let _ = write!(page, "\n## {shown}\n\n");
    if let Some(text) = description(schema) {
        let _ = write!(page, "{text}\n\n");
    }
    let mut below = Vec::new();
    if let Some(kinds) = schema["oneOf"].as_array() {
        page.push_str("| kind | key | value | default | meaning |\n|---|---|---|---|---|\n");
        for kind in kinds {
            let name = kind["properties"]["kind"]["const"].as_str().unwrap_or_default();
            let meaning = description(kind).unwrap_or_default();
            let _ = writeln!(page, "| `{name}` | | | | {meaning} |");
            rows(page, path, kind, true, &mut below);
        }
    } else {
        page.push_str("| key | value | default | meaning |\n|---|---|---|---|\n");
        rows(page, path, schema, false, &mut below);
    }
    for (path, schema) in below {
        table(page, &path, &schema);
    }
}

/// One row for each key; what is a table of its own goes `below`.
fn rows(page: &mut String, path: &str, schema: &Value, of_a_kind: bool, below: &mut Vec<(String, Value)>) {
    let required: Vec<&str> = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    for (key, value) in schema["properties"].as_object().into_iter().flatten() {
        if of_a_kind && key == "kind" {
            continue;
        }
        let default = match () {
            () if required.contains(&key.as_str()) => "required".to_string(),
            () if value["default"].is_null() || is_empty(&value["default"]) => "left out".to_string(),
            () => format!("`{}`", value["default"]),
        };
        let first = if of_a_kind { "| " } else { "" };
        let meaning = description(value).unwrap_or_default();
        let _ = writeln!(page, "{first}| `{key}` | {} | {default} | {meaning} |", form(value));
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        if let Some((path, own)) = own_table(&path, value) {
            below.push((path, own));
        }
    }
}

fn is_empty(value: &Value) -> bool {
    value.as_array().is_some_and(Vec::is_empty) || value.as_object().is_some_and(serde_json::Map::is_empty)
}

/// Description in one line.
fn description(schema: &Value) -> Option<String> {
    let text = schema["description"].as_str()?;
    Some(text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|"))
}

/// The table that a key holds, if it holds one.
fn own_table(path: &str, schema: &Value) -> Option<(String, Value)> {
    if is_quantity(schema) {
        return None;
    }
    if schema["items"]["properties"].is_object() {
        return (!is_quantity(&schema["items"])).then(|| (format!("{path}[]"), schema["items"].clone()));
    }
    if schema["additionalProperties"].is_object() {
        return Some((format!("{path}.NAME"), schema["additionalProperties"].clone()));
    }
    let optional = schema["anyOf"].as_array().and_then(|both| both.iter().find(|one| one["properties"].is_object()));
    let own = optional.unwrap_or(schema);
    (own["properties"].is_object() || own["oneOf"].is_array()).then(|| (path.to_string(), own.clone()))
}

fn is_quantity(schema: &Value) -> bool {
    schema["properties"]["unit"]["const"].is_string()
}

/// What a key holds, in words.
fn form(schema: &Value) -> String {
    if is_quantity(schema) {
        let unit = schema["properties"]["unit"]["const"].as_str().unwrap_or_default();
        return format!("{}, {unit}", number(&schema["properties"]["value"]));
    }
    if schema["items"].is_object() {
        let items = &schema["items"];
        return if is_quantity(items) || items["properties"].is_null() {
            format!("list: {}", form(items))
        } else {
            "tables".to_string()
        };
    }
    let kind = match &schema["type"] {
        Value::Array(kinds) => kinds.first().and_then(Value::as_str),
        kind => kind.as_str(),
    };
    match kind {
        Some("string") => "text".to_string(),
        Some("boolean") => "true or false".to_string(),
        Some("integer") => "whole number".to_string(),
        Some("number") => number(schema),
        _ => "table".to_string(),
    }
}

fn number(schema: &Value) -> String {
    if schema["exclusiveMinimum"].as_f64() == Some(0.0) {
        return "number above 0".to_string();
    }
    match schema["minimum"].as_f64() {
        Some(least) => format!("number from {least}"),
        None => "number".to_string(),
    }
}

fn effect(page: &mut String, form: &EffectForm) {
    let name = &form.effect.card().name;
    if form.parameters.is_empty() {
        let _ = writeln!(page, "| `{name}` | none | | {} |", form.effect.card().summary);
    }
    for (parameter, cards) in &form.parameters {
        let units: Vec<&str> = cards.iter().map(|card| &*card.unit).collect();
        let _ = writeln!(page, "| `{name}` | `{parameter}` | {} | {} |", units.join(" or "), cards[0].meaning);
    }
}
