//! `excavator compare`

use std::path::Path;

use excavator_identification::report::comparison_page;
use excavator_identification::validation::compare;

use super::print;
use crate::cli::CompareArguments;
use crate::error::VerbError;
use crate::output::{comparison_json, comparison_table, phase_table, write_json};
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
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        print(&format!("{} simulated with the input of {}", model.machine.name, recording.source));
        print(&comparison_table(&comparison).to_string());
        if let Some(table) = phase_table(&comparison) {
            print(&table.to_string());
        }
    }
    if let Some(path) = &arguments.report {
        outputs::write(path, &comparison_page(&model, std::slice::from_ref(&comparison)), arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &comparison_json(&comparison), arguments.overwriting)?;
    }
    Ok(())
}
