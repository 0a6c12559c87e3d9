//! Identified parameters.

use excavator_identification::fit::ProfileInterval;
use serde_json::{Value, json};

use super::fits::identification_json;
use crate::identified::Identified;

/// Result of `identify`.
pub fn identified_json(result: &Identified) -> Value {
    let equations = result.equations.iter().map(|gauge| {
        let chi = gauge.chi_squared_per_row;
        json!({
            "equation": gauge.equation,
            "chi_squared_per_row": chi.is_finite().then_some(chi),
            "relative_residual": gauge.relative_residual,
            "rows": gauge.rows,
        })
    });
    let mut value = identification_json(
        &result.model,
        &result.fitted,
        &result.conditions,
        result.rows,
        equations.collect(),
        &result.not_identified,
    );
    if !result.profiles.is_empty() {
        value["profiles"] = profiles_json(result);
    }
    value
}

fn profiles_json(result: &Identified) -> Value {
    let names = result.model.parameter_names();
    let one = |profile: &ProfileInterval| {
        json!({
            "name": names[profile.index],
            "lower": profile.lower,
            "upper": profile.upper,
            "identifiable": profile.is_identifiable(),
            "moves_with": profile.companion.map(|(other, correlation)| json!({"name": names[other], "correlation": correlation})),
        })
    };
    Value::Array(result.profiles.iter().map(one).collect())
}
