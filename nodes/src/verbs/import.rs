//! `excavator import`

use std::path::Path;

use excavator_bags::map::{guess, read_recording_or_mapped};
use excavator_bags::{Topics, WriteOptions, write_recording};
use excavator_model::recording::is_measured;

use super::print;
use crate::cli::ImportArguments;
use crate::error::VerbError;
use crate::outputs::{self, Inputs};
use crate::terminal;

pub fn run(arguments: &ImportArguments) -> Result<(), VerbError> {
    match &arguments.output {
        _ if arguments.guess => guess_map(arguments),
        Some(bag) => import(arguments, bag),
        // The command line does not let this happen.
        None => Ok(()),
    }
}

fn guess_map(arguments: &ImportArguments) -> Result<(), VerbError> {
    // The map beside the data is not read here, and may be made anew.
    let inputs = Inputs::recording(&arguments.data);
    outputs::check(&[("-o", arguments.output.as_deref())], &inputs, arguments.overwriting)?;
    let guessed = guess(&arguments.data, &arguments.cylinder)?;
    let text = guessed.to_text().map_err(excavator_bags::BagError::from)?;
    outputs::standard_output(&text)?;
    match &arguments.output {
        Some(path) if path != Path::new("-") => outputs::write(path, &text, arguments.overwriting),
        _ => Ok(()),
    }
}

fn import(arguments: &ImportArguments, bag: &Path) -> Result<(), VerbError> {
    let inputs = Inputs::recordings([&arguments.data], arguments.map.as_deref());
    outputs::check_bag(bag, &inputs, arguments.overwriting)?;
    let (recording, report) = read_recording_or_mapped(&arguments.data, arguments.map.as_deref())?;
    for problem in report.problems() {
        terminal::complain(&format!("{}: {problem}", arguments.data.display()));
    }
    let options = WriteOptions { replace: arguments.overwriting.force, ..WriteOptions::default() };
    write_recording(bag, &recording, &Topics::default(), &options)?;
    let measured: Vec<String> =
        recording.signals().into_iter().filter(|(_, values)| is_measured(values)).map(|(name, _)| name).collect();
    print(&format!(
        "{}: {} samples, {:.2} s, {}",
        bag.display(),
        recording.len(),
        recording.duration(),
        measured.join(", ")
    ));
    Ok(())
}
