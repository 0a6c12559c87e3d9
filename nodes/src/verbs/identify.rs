//! `excavator identify`

use std::path::{Path, PathBuf};

use excavator_identification::fit::ProfileInterval;
use excavator_identification::identify::{Identified, identify};
use excavator_identification::results;
use excavator_model::document::to_text;
use excavator_model::recording::Recording;
use excavator_model::{Model, Parameter};
use excavator_report::implausible_sentence;

use super::{print, print_detail, print_next};
use crate::cli::IdentifyArguments;
use crate::error::VerbError;
use crate::output::{NextStep, number, parameter_table, remedy_lines, write_json};
use crate::outputs::{self, Inputs};
use crate::sources;

pub fn run(arguments: &IdentifyArguments) -> Result<(), VerbError> {
    let outputs = [("-o", arguments.output.as_deref()), ("--json", arguments.json.json.as_deref())];
    let inputs = Inputs::recordings(&arguments.bag, arguments.mapping.map.as_deref());
    // With --force the model may become its own successor: it has a history.
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    outputs::check(&outputs[1..], &inputs.and_all(arguments.model.files()), arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let recordings = sources::telling_recordings(&arguments.bag, arguments.extent, &arguments.mapping, &model)?;
    let recordings: Vec<&Recording> = recordings.iter().collect();
    let method = arguments.method.into();
    let mut result = identify(&model, &recordings, method)?;
    result.add_history(&jiff::Timestamp::now().to_string(), method, &recordings);
    if let Some(path) = &arguments.output {
        outputs::write(path, &to_text(&result.model)?, arguments.overwriting)?;
    }
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&model, &result);
        print_next(&next(arguments));
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &results::Identification::of(&result), arguments.overwriting)?;
    }
    Ok(())
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
