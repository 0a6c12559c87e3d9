//! `excavator identify`

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use excavator_identification::identify::Identified;
use excavator_model::Model;
use excavator_model::document::to_text;
use excavator_report::implausible_sentence;
use excavator_study::Study;
use excavator_study::numbers::number;
use excavator_study::sentences::{identification_sentence, profile_sentence};

use crate::cli::{IdentifyArguments, Method};
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{parameter_table, print, print_detail, remedy_lines};

pub fn run(arguments: &IdentifyArguments) -> Result<(), VerbError> {
    let outputs = [("-o", arguments.output.as_deref()), arguments.result.output()];
    let inputs = Inputs::recordings(&arguments.bag, arguments.mapping.map.as_deref());
    // With --force the output may replace the input model, which keeps its history.
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    files::check(&outputs[1..], &inputs.and_all(arguments.model.files()), arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let recordings = arguments.mapping.preparation(arguments.extent).recordings(&arguments.bag, &model)?;
    let goes_on = |_| ControlFlow::Continue(());
    let identified = Study::of_fitted(model, recordings).identify(arguments.method.into(), &goes_on)?;
    if let Some(path) = &arguments.output {
        files::write(path, &to_text(&identified.result.model)?, arguments.result.overwriting)?;
    }
    if arguments.result.is_shown() {
        show(&identified.given, &identified.result);
        print_next(&next(arguments));
    }
    files::write_told(&identified, None, &arguments.result)
}

/// Compare the identified model with the recording, or save the model first.
fn next(arguments: &IdentifyArguments) -> NextStep {
    let bag = arguments.bag.first().map(PathBuf::as_path).unwrap_or(Path::new("BAG"));
    match &arguments.output {
        Some(model) => NextStep::new("compare the identified model with a recording", "compare")
            .model(model, &arguments.model)
            .path("--bag", bag)
            .mapping(&arguments.mapping)
            .extent(arguments.extent),
        None => {
            let step =
                NextStep::new("keep the identified model", "identify").same_model(&arguments.model).word("--bag");
            let step = arguments.bag.iter().fold(step, |step, bag| step.word(bag.display().to_string()));
            let step = step.mapping(&arguments.mapping).extent(arguments.extent);
            // Another method would keep other numbers than those on the screen.
            let step = match arguments.method.to_possible_value() {
                Some(method) if arguments.method != Method::Best => step.word("--method").word(method.get_name()),
                _ => step,
            };
            step.new_file("-o", "identified.toml")
        }
    }
}

fn show(given: &Model, result: &Identified) {
    print(&identification_sentence(result));
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
