//! `excavator compare`

use std::path::Path;

use excavator_identification::report::{comparison_page, comparison_sentence};
use excavator_identification::validation::{Baselines, compare};

use super::{print, print_detail, print_next};
use crate::cli::CompareArguments;
use crate::error::VerbError;
use crate::output::{NextStep, comparison_json, comparison_table, correlation_table, phase_table, write_json};
use crate::outputs::{self, Inputs};
use crate::sources;

pub fn run(arguments: &CompareArguments) -> Result<(), VerbError> {
    let outputs = [("--report", arguments.report.as_deref()), ("--json", arguments.json.json.as_deref())];
    let inputs =
        Inputs::recordings([&arguments.bag], arguments.mapping.map.as_deref()).and_all(arguments.model.files());
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let recording = sources::telling_recording(&arguments.bag, arguments.extent, &arguments.mapping, &model)?;
    let comparison = compare(&model, &recording)?;
    let baselines = Baselines::of(&model, &recording, &comparison);
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        print(&comparison_sentence(&comparison, &baselines));
        print(&comparison_table(&comparison, &baselines).to_string());
        print_detail(&correlation_table(&comparison).to_string());
        if let Some(table) = phase_table(&comparison) {
            print_detail(&table.to_string());
        }
        let (why, duration) = ("find out what the model is missing", comparison.measured.duration());
        print_next(&NextStep::diagnosis_of_halves(why, &arguments.model, &arguments.bag, duration, &arguments.mapping));
    }
    if let Some(path) = &arguments.report {
        let page = comparison_page(&model, std::slice::from_ref(&comparison), std::slice::from_ref(&baselines));
        outputs::write(path, &page, arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &comparison_json(&comparison, &baselines), arguments.overwriting)?;
    }
    Ok(())
}
