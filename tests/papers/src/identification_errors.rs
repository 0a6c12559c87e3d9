//! Errors of all parameters of \[A\] by three methods, and condition numbers.

use excavator_identification::fit::{FitSettings, fit};
use excavator_identification::regression::{WeakFormSettings, least_squares, weak_form};
use excavator_model::Model;
use excavator_model::recording::Recording;
use rayon::prelude::*;

use crate::experiment::{SEEDS, Sine, figure, mean, nominal, off_by, read};

/// Noise of pressures, Pa.
const LEVELS: [f64; 2] = [2e3, 2e4];

/// From mid-stroke, as the figures of \[A\] show.
const SINE: Sine = Sine { frequency: 0.5, start: 0.0, duration: 16.0, tank: 0.0 };

/// By how much the start values of weak form and output error are off.
const SPREAD: f64 = 0.12;

/// Parameters and their symbols in \[A\].
const PARAMETERS: [(&str, &str); 12] = [
    ("arm.inertia", "J2"),
    ("arm.viscous_damping", "Fd2"),
    ("arm.coulomb_friction", "Fc2"),
    ("arm.gravity_moment", "W2"),
    ("arm.bulk_modulus", "b"),
    ("pump.bulk_modulus", "bp"),
    ("arm.flow_gain_cap", "Cf+"),
    ("arm.flow_gain_rod", "Cf-"),
    ("arm.internal_leakage", "Ci"),
    ("arm.external_leakage_cap", "Ce+"),
    ("arm.external_leakage_rod", "Ce-"),
    ("pump.bypass_flow_gain", "Cft"),
];

/// Relative errors of all parameters in %, by method: least squares, weak form, output error. `NaN` where one is not determined.
type Errors = [[f64; 3]; 12];

/// Errors under one level of noise and one seed.
fn errors_of(truth: &Model, recording: &Recording, level: f64, seed: u64) -> Result<Errors, String> {
    let read = read(recording, level, seed);
    let given = off_by(SPREAD)?;
    let printed = least_squares(&given, &[&read]).map_err(|error| error.to_string())?;
    let weak = weak_form(&given, &[&read], &WeakFormSettings::default()).map_err(|error| error.to_string())?;
    let fitted = fit(&weak.model, &[&read], &FitSettings::default()).map_err(|error| error.to_string())?;
    let names = truth.parameter_names();
    let models = [(&printed.model, &printed.fitted), (&weak.model, &weak.fitted), (&fitted.model, &fitted.fitted)];
    Ok(PARAMETERS.map(|(name, _)| {
        models.map(|(model, found)| {
            let determined = names.iter().position(|own| own == name).is_some_and(|index| found.contains(&index));
            match (model.value_of(name), truth.value_of(name)) {
                (Some(value), Some(wanted)) if determined => 100.0 * (value / wanted - 1.0),
                _ => f64::NAN,
            }
        })
    }))
}

/// Mean over the seeds, and the largest by size.
fn cell(values: &[f64]) -> String {
    let known: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    if known.len() < values.len() {
        return format!("not determined in {} of {}", values.len() - known.len(), values.len());
    }
    let worst = known.iter().fold(0.0_f64, |worst, value| worst.max(value.abs()));
    format!("{} ({})", percent(mean(&known)), percent(worst).trim_start_matches('+'))
}

fn percent(value: f64) -> String {
    figure(value, true)
}

/// The table of errors.
pub fn errors() -> Result<String, String> {
    let truth = nominal()?;
    let recording = SINE.on(&truth)?;
    let runs: Vec<(f64, u64)> = LEVELS.into_iter().flat_map(|level| SEEDS.map(|seed| (level, seed))).collect();
    let all = runs.into_par_iter().map(|(level, seed)| Ok((level, errors_of(&truth, &recording, level, seed)?)));
    let all = all.collect::<Result<Vec<(f64, Errors)>, String>>()?;
    let mut text = String::from(
        "| error, %: mean of five seeds (largest) | least squares, 2 kPa | weak form, 2 kPa | output error, 2 kPa | least squares, 20 kPa | weak form, 20 kPa | output error, 20 kPa |\n|---|---|---|---|---|---|---|\n",
    );
    for (row, (_, symbol)) in PARAMETERS.iter().enumerate() {
        let cells = LEVELS.iter().flat_map(|level| (0..3).map(move |method| (level, method))).map(|(level, method)| {
            let own = all.iter().filter(|(of, _)| of == level);
            cell(&own.map(|(_, errors)| errors[row][method]).collect::<Vec<f64>>())
        });
        text += &format!("| {symbol} | {} |\n", cells.collect::<Vec<_>>().join(" | "));
    }
    Ok(text)
}

/// Condition numbers of the printed regressors, beside those of \[A\].
pub fn condition_numbers() -> Result<String, String> {
    let truth = nominal()?;
    let mut text = String::from(
        "| condition number of the printed regressors | columns in SI units | columns of length one |\n|---|---|---|\n",
    );
    for (place, start) in [("from mid-stroke", 0.0), ("nearly extended", 0.27)] {
        let recording = Sine { start, ..SINE }.on(&truth)?;
        let found = least_squares(&truth, &[&recording]).map_err(|error| error.to_string())?;
        for one in &found.condition_numbers {
            let number = |value: f64| {
                if value < 1e4 {
                    format!("{value:.3e}").parse::<f64>().map_or(String::new(), |value| value.to_string())
                } else {
                    format!("{value:.1e}")
                }
            };
            text += &format!("| {}, {place} | {} | {} |\n", one.group, number(one.unscaled), number(one.scaled));
        }
    }
    Ok(text + "| [A], as printed | 26 and 220 | |\n")
}
