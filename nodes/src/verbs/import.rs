//! `excavator import`

use excavator_bags::map::{guess, read_recording_or_mapped};
use excavator_bags::{Topics, WriteOptions, write_recording};
use excavator_model::recording::is_measured;

use super::print;
use crate::cli::ImportArguments;
use crate::error::VerbError;
use crate::sources;

pub fn run(arguments: &ImportArguments) -> Result<(), VerbError> {
    match &arguments.output {
        _ if arguments.guess => guess_map(arguments),
        Some(bag) => import(arguments, bag),
        // The command line does not let this happen.
        None => Ok(()),
    }
}

fn guess_map(arguments: &ImportArguments) -> Result<(), VerbError> {
    let guessed = guess(&arguments.data, &arguments.cylinder)?;
    let text = guessed.to_text().map_err(excavator_bags::BagError::from)?;
    print(text.trim_end());
    if let Some(path) = &arguments.output {
        sources::write_text(path, &text)?;
    }
    Ok(())
}

fn import(arguments: &ImportArguments, bag: &std::path::Path) -> Result<(), VerbError> {
    let (recording, report) = read_recording_or_mapped(&arguments.data, arguments.mapping.map.as_deref())?;
    for problem in report.problems() {
        eprintln!("{}: {problem}", arguments.data.display());
    }
    write_recording(bag, &recording, &Topics::default(), &WriteOptions::default())?;
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
