//! The machine of the long recordings.

use excavator_model::Model;
use excavator_model::document::built_in;

/// Factors on the published parameters, so that identification does not begin at the truth.
const FACTORS: [(&str, f64); 5] = [
    ("arm.inertia", 1.15),
    ("arm.viscous_damping", 0.85),
    ("arm.bulk_modulus", 1.1),
    ("arm.flow_gain_cap", 0.9),
    ("pump.bypass_flow_gain", 1.08),
];

/// The arm of \[A\] with other parameters.
///
/// # Errors
/// In words, where the built-in model is not as it was.
pub fn truth() -> Result<Model, String> {
    let mut model = built_in("zx30u-arm").map_err(|error| error.to_string())?;
    let mut values = model.parameter_values();
    for (name, factor) in FACTORS {
        let index = model.parameter_names().iter().position(|other| other == name);
        values[index.ok_or_else(|| format!("no parameter {name}"))?] *= factor;
    }
    model.set_parameter_values(&values);
    Ok(model)
}

/// Largest distance of identified parameters from the truth, as a share of their 95 % margins: inertia, damping, bulk modulus, gains.
///
/// # Errors
/// In words, where the result has not these parameters.
pub fn largest_error(identified: &serde_json::Value) -> Result<f64, String> {
    let model = truth()?;
    let parameters = identified["parameters"].as_array().ok_or("no parameters in the result")?;
    let error = |name: &str| {
        let found = parameters.iter().find(|entry| entry["name"] == name)?;
        Some((found["value"].as_f64()? - model.value_of(name)?).abs() / found["margin_95"].as_f64()?)
    };
    FACTORS.iter().try_fold(0.0, |most: f64, (name, _)| {
        error(name).map(|error| most.max(error)).ok_or_else(|| format!("{name} was not identified"))
    })
}
