//! `excavator identify`

use std::path::{Path, PathBuf};

use excavator_identification::fit::{
    FitSettings, ProfileInterval, fit, profile, simplified, with_nuisances, with_nuisances_of,
};
use excavator_identification::regression::{
    ConditionNumber, EquationGauge, Regression, RegressionError, WeakFormSettings, least_squares, weak_form,
};
use excavator_model::document::to_text;
use excavator_model::effects::Family;
use excavator_model::recording::Recording;
use excavator_model::{HistoryEntry, Model, Parameter};
use excavator_report::implausible_sentence;
use serde_json::{Value, json};

use super::{print, print_detail, print_next};
use crate::cli::{IdentifyArguments, Method};
use crate::error::VerbError;
use crate::output::{NextStep, identification_json, number, parameter_table, remedy_lines, write_json};
use crate::outputs::{self, Inputs};
use crate::sources;

struct Identified {
    model: Model,
    fitted: Vec<usize>,
    conditions: Vec<ConditionNumber>,
    rows: usize,
    equations: Vec<EquationGauge>,
    not_identified: Vec<(usize, String)>,
    /// Of parameters whose standard errors say little.
    profiles: Vec<ProfileInterval>,
}

pub fn run(arguments: &IdentifyArguments) -> Result<(), VerbError> {
    let outputs = [("-o", arguments.output.as_deref()), ("--json", arguments.json.json.as_deref())];
    let inputs = Inputs::recordings(&arguments.bag, arguments.mapping.map.as_deref());
    // With --force the model may become its own successor: it has a history.
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    outputs::check(&outputs[1..], &inputs.and_all(arguments.model.files()), arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let recordings = sources::telling_recordings(&arguments.bag, arguments.extent, &arguments.mapping, &model)?;
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
        outputs::write(path, &to_text(&result.model)?, arguments.overwriting)?;
    }
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&model, &result);
        print_next(&next(arguments));
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
        let mut value = identification_json(
            &result.model,
            &result.fitted,
            &result.conditions,
            result.rows,
            equations.collect(),
            &result.not_identified,
        );
        if !result.profiles.is_empty() {
            value["profiles"] = profiles_json(&result);
        }
        write_json(path, &value, arguments.overwriting)?;
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
        Method::WeakForm => Some(in_weak_form(model, recordings)?),
        // Where the equations lack signals the given values are the start.
        Method::OutputError => in_weak_form(model, recordings).ok(),
    };
    let mut result = match regression {
        Some(regression) => Identified {
            model: regression.model,
            fitted: regression.fitted,
            conditions: regression.condition_numbers,
            rows: regression.rows,
            equations: regression.equations,
            not_identified: regression.not_identified,
            profiles: Vec::new(),
        },
        None => Identified {
            model: model.clone(),
            fitted: Vec::new(),
            conditions: Vec::new(),
            rows: 0,
            equations: Vec::new(),
            not_identified: Vec::new(),
            profiles: Vec::new(),
        },
    };
    if method == Method::OutputError {
        let settings = FitSettings { sample_rate: f64::INFINITY, ..FitSettings::default() };
        let fitted = fit(&with_nuisances(&result.model, recordings), recordings, &settings)?;
        let fitted = simplified(model, &fitted, recordings, &settings)?;
        result.profiles = fitted
            .undetermined()
            .into_iter()
            .map(|index| profile(&fitted, recordings, &FitSettings::default(), index))
            .collect::<Result<_, _>>()?;
        result.model = fitted.model;
        result.fitted = fitted.fitted;
        result.not_identified.clear();
    }
    Ok(result)
}

fn in_weak_form(model: &Model, recordings: &[&Recording]) -> Result<Regression, RegressionError> {
    let extended = with_nuisances_of(model, &[Family::Recording], recordings);
    Ok(weak_form(&extended, recordings, &WeakFormSettings::default())?.simplified(model))
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

/// What the recordings say of a parameter that they hardly show.
fn profile_sentence(profile: &ProfileInterval, model: &Model) -> String {
    let names = model.parameter_names();
    let unit = model.parameters().nth(profile.index).map_or("", |(_, parameter)| &*parameter.card.unit);
    let name = &names[profile.index];
    let mut text = match (profile.lower, profile.upper) {
        (None, None) => {
            format!("{name} is not identifiable from these recordings: all values in its range fit equally well")
        }
        (Some(lower), None) => {
            format!("{name} is at least {} {unit} (95 %); every larger value fits as well", number(lower))
        }
        (None, Some(upper)) => {
            format!("{name} is at most {} {unit} (95 %); every smaller value fits as well", number(upper))
        }
        (Some(lower), Some(upper)) => {
            format!("{name} is between {} and {} {unit} (95 %, profile likelihood)", number(lower), number(upper))
        }
    };
    if let Some((other, correlation)) = profile.companion {
        text += &format!("; {} compensates for changes of it (correlation {correlation:.2})", names[other]);
    }
    text
}

/// The identified model beside the recording; first of all it has to be kept.
fn next(arguments: &IdentifyArguments) -> NextStep {
    let bag = arguments.bag.first().map(PathBuf::as_path).unwrap_or(Path::new("BAG"));
    match &arguments.output {
        Some(model) => NextStep::new("compare the identified model with a recording", "compare")
            .model(model, &arguments.model)
            .path("--bag", bag)
            .mapping(&arguments.mapping),
        None => {
            let step =
                NextStep::new("keep the identified model", "identify").same_model(&arguments.model).word("--bag");
            let step = arguments.bag.iter().fold(step, |step, bag| step.word(bag.display().to_string()));
            step.mapping(&arguments.mapping).path("-o", Path::new("identified.toml"))
        }
    }
}

/// How many parameters were identified, how well, and what the equations leave.
fn summary(result: &Identified) -> String {
    let machine = &result.model.machine.name;
    let asked = result.fitted.len() + result.not_identified.len();
    let names = result.model.parameter_names();
    let share = |(index, parameter): (usize, &Parameter)| {
        let margin = parameter.margin_95.filter(|margin| margin.is_finite() && parameter.value != 0.0)?;
        Some((margin / parameter.value.abs(), names[index].as_str()))
    };
    let parameters = result.model.parameters().map(|(_, parameter)| parameter).enumerate();
    let fitted = parameters.filter(|(index, _)| result.fitted.contains(index));
    let widest = fitted.filter_map(share).max_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = format!("Identified {} of {asked} unknown parameters of {machine}.", result.fitted.len());
    if let Some((share, name)) = widest {
        text += &format!(" The widest 95 % interval is that of {name}: ± {:.1} % of its value.", 100.0 * share);
    }
    let known = result.equations.iter().filter(|gauge| gauge.chi_squared_per_row.is_finite());
    if let Some(worst) = known.max_by(|a, b| a.chi_squared_per_row.total_cmp(&b.chi_squared_per_row)) {
        text += &format!(
            " The largest residual is that of {}: {} times the variance of sensor noise.",
            worst.equation,
            number(worst.chi_squared_per_row)
        );
    }
    text
}

fn show(given: &Model, result: &Identified) {
    print(&summary(result));
    print(&parameter_table(&result.model, &result.fitted).to_string());
    remedy_lines(&result.model, &result.fitted).iter().for_each(|line| print(line));
    for condition in &result.conditions {
        print_detail(&format!(
            "condition number, {}: {} in SI units, {} with columns scaled",
            condition.group,
            number(condition.unscaled),
            number(condition.scaled)
        ));
    }
    for gauge in result.equations.iter().filter(|gauge| gauge.chi_squared_per_row.is_finite()) {
        print_detail(&format!(
            "{}: squared residual {} times what sensor noise explains ({} rows)",
            gauge.equation,
            number(gauge.chi_squared_per_row),
            gauge.rows
        ));
    }
    for profile in &result.profiles {
        print(&profile_sentence(profile, &result.model));
    }
    let names = result.model.parameter_names();
    for (index, reason) in &result.not_identified {
        print(&format!("{} was not identified: {reason}", names[*index]));
    }
    if let Some(sentence) = implausible_sentence(given, &result.model) {
        print(&sentence);
    }
}
