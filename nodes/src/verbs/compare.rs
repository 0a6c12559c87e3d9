//! `excavator compare`

use std::path::Path;

use excavator_identification::results;
use excavator_identification::validation::{Baselines, compare, compare_runs};
use excavator_report::{Beside, comparison_page, comparison_sentence, others_sentence};

use super::{print, print_detail, print_next};
use crate::cli::CompareArguments;
use crate::error::VerbError;
use crate::output::{NextStep, comparison_table, correlation_table, phase_table, write_json};
use crate::outputs::{self, Inputs};
use crate::sources;

pub fn run(arguments: &CompareArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), ("--json", arguments.json.json.as_deref())];
    let bags = std::iter::once(&arguments.bag).chain(&arguments.repeat);
    let inputs = Inputs::recordings(bags, arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let recording = sources::telling_recording(&arguments.bag, arguments.extent, &arguments.mapping, &model)?;
    let comparison = compare(&model, &recording)?;
    let baselines = Baselines::of(&model, &recording, &comparison);
    let against =
        arguments.against.as_deref().map(|name| sources::another_model(name, &arguments.model)).transpose()?;
    let against = against.map(|model| compare(&model, &recording)).transpose()?;
    let again =
        arguments.repeat.as_deref().map(|bag| sources::recording(bag, &arguments.mapping, &model)).transpose()?;
    let again = again.map(|again| compare_runs(&model, &recording, &again)).transpose()?;
    let others: Vec<Beside<'_>> = (against.iter().map(Beside::Model)).chain(again.iter().map(Beside::Run)).collect();
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        print(&comparison_sentence(&comparison, &baselines));
        others.iter().for_each(|other| print(&others_sentence(&comparison, *other)));
        print(&comparison_table(&comparison, &baselines, &others).to_string());
        print_detail(&correlation_table(&comparison).to_string());
        if let Some(table) = phase_table(&comparison) {
            print_detail(&table.to_string());
        }
        let (why, duration) = ("find out what the model is missing", comparison.measured.duration());
        print_next(&NextStep::diagnosis_of_halves(why, &arguments.model, &arguments.bag, duration, &arguments.mapping));
    }
    if let Some(path) = &arguments.report {
        let (one, its_baselines) = (std::slice::from_ref(&comparison), std::slice::from_ref(&baselines));
        let page = comparison_page(&model, one, its_baselines, &others);
        outputs::write(path, &page, arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        let result = results::Comparison::of(&comparison, &baselines, against.as_ref(), again.as_ref());
        write_json(path, &result, arguments.overwriting)?;
    }
    Ok(())
}
