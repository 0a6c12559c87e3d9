//! A formula effect as a file holds it.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A formula effect: a `[[formula]]` of a catalogue or a model file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FormulaText {
    /// Name of the effect, a word of its own.
    pub name: String,
    /// The row of the equations that the formula enters; `excavator effects --language` lists them.
    pub acts_on: String,
    /// The formula.
    pub formula: String,
    /// What the effect is, in a sentence.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub summary: String,
    /// Where the formula comes from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// How it shows in data.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub shows: String,
    /// Which experiment shows it best.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub experiment: String,
    /// Its parameters and constants by name.
    #[serde(default)]
    pub parameters: BTreeMap<String, ParameterText>,
    /// Its states by name, for a law with memory.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub states: BTreeMap<String, StateText>,
}

/// A parameter of a formula, or a constant.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterText {
    /// SI unit, "-" for a pure number.
    pub unit: String,
    /// Least plausible value; left out: zero where no start is below zero, else minus the maximum.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub minimum: Option<f64>,
    /// Largest plausible value; left out: a million times the largest start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub maximum: Option<f64>,
    /// Values from which a search begins: the best fit wins.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub start: Vec<f64>,
    /// Value of a constant.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub value: Option<f64>,
    /// Whether it is a constant, which a fit leaves alone.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub known: bool,
    /// What it means.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub meaning: String,
}

/// A state of a formula.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateText {
    /// Formula of its value where a recording begins, in the state's unit.
    pub start: String,
    /// Formula of its rate, in the state's unit per second.
    pub rate: String,
    /// SI unit, "-" for a pure number.
    pub unit: String,
    /// Order of magnitude, for the accuracy of a simulation; left out: one that is usual for the unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub typical: Option<f64>,
}
