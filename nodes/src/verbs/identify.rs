//! `excavator identify`

use std::path::Path;

use excavator_identification::fit::{FitSettings, fit};
use excavator_identification::regression::{
    ConditionNumber, EquationGauge, WeakFormSettings, least_squares, weak_form,
};
use excavator_model::document::to_text;
use excavator_model::recording::Recording;
use excavator_model::{HistoryEntry, Model};
use serde_json::json;

use super::print;
use crate::cli::{IdentifyArguments, Method};
use crate::error::VerbError;
use crate::output::{identification_json, number, parameter_table, write_json};
use crate::sources;

struct Identified {
    model: Model,
    fitted: Vec<usize>,
    conditions: Vec<ConditionNumber>,
    rows: usize,
    equations: Vec<EquationGauge>,
    not_identified: Vec<(usize, String)>,
}

pub fn run(arguments: &IdentifyArguments) -> Result<(), VerbError> {
    let model = sources::model(&arguments.model)?;
    let recordings = sources::recordings(&arguments.bag, &arguments.mapping, &model)?;
    let recordings: Vec<&Recording> = recordings.iter().collect();
    let mut result = identify(&model, &recordings, arguments.method)?;
    result.model.history.push(HistoryEntry {
        when: jiff::Timestamp::now().to_string(),
        what: format!("parameters identified ({})", method_name(arguments.method)),
        recordings: recordings.iter().map(|recording| recording.source.clone()).collect(),
        validation_error_before: None,
        validation_error_after: None,
    });
    if let Some(path) = &arguments.output {
        sources::write_text(path, &to_text(&result.model)?)?;
    }
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&result);
    }
    if let Some(path) = &arguments.json.json {
        let equations = result.equations.iter().map(|gauge| {
            let chi = gauge.chi_squared_per_row;
            json!({
                "equation": gauge.equation,
                "chi_squared_per_row": chi.is_finite().then_some(chi),
                "relative_residual": gauge.relative_residual,
                "rows": gauge.rows,
            })
        });
        let value = identification_json(
            &result.model,
            &result.fitted,
            &result.conditions,
            result.rows,
            equations.collect(),
            &result.not_identified,
        );
        write_json(path, &value)?;
    }
    Ok(())
}

fn method_name(method: Method) -> &'static str {
    match method {
        Method::WeakForm => "weak form with instruments",
        Method::LeastSquares => "least squares",
        Method::OutputError => "output error",
    }
}

fn identify(model: &Model, recordings: &[&Recording], method: Method) -> Result<Identified, VerbError> {
    let regression = match method {
        Method::LeastSquares => Some(least_squares(model, recordings)?),
        Method::WeakForm => Some(weak_form(model, recordings, &WeakFormSettings::default())?),
        // Where the equations lack signals the given values are the start.
        Method::OutputError => weak_form(model, recordings, &WeakFormSettings::default()).ok(),
    };
    let mut result = match regression {
        Some(regression) => Identified {
            model: regression.model,
            fitted: regression.fitted,
            conditions: regression.condition_numbers,
            rows: regression.rows,
            equations: regression.equations,
            not_identified: regression.not_identified,
        },
        None => Identified {
            model: model.clone(),
            fitted: Vec::new(),
            conditions: Vec::new(),
            rows: 0,
            equations: Vec::new(),
            not_identified: Vec::new(),
        },
    };
    if method == Method::OutputError {
        let settings = FitSettings { sample_rate: f64::INFINITY, ..FitSettings::default() };
        let fitted = fit(&result.model, recordings, &settings)?;
        result.model = fitted.model;
        result.fitted = fitted.fitted;
        result.not_identified.clear();
    }
    Ok(result)
}

fn show(result: &Identified) {
    print(&parameter_table(&result.model, &result.fitted).to_string());
    for condition in &result.conditions {
        print(&format!(
            "condition number, {}: {} in SI units, {} with columns scaled",
            condition.group,
            number(condition.unscaled),
            number(condition.scaled)
        ));
    }
    for gauge in result.equations.iter().filter(|gauge| gauge.chi_squared_per_row.is_finite()) {
        print(&format!(
            "{}: squared residual {} times what sensor noise explains ({} rows)",
            gauge.equation,
            number(gauge.chi_squared_per_row),
            gauge.rows
        ));
    }
    let names = result.model.parameter_names();
    for (index, reason) in &result.not_identified {
        print(&format!("{} was not identified: {reason}", names[*index]));
    }
}
