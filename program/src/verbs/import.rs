//! `excavator import`

mod questions;

use std::io::IsTerminal;
use std::path::Path;

use excavator_bags::map::{Confidence, Guess, Hints, guess, read_pieces};
use excavator_bags::{Topics, write_recording};
use excavator_model::recording::is_measured;
use excavator_study::sheet::Sheet;
use rosbag2::WriteOptions;

use crate::cli::{ImportArguments, ModelChoice, OwnEffects};
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{self, print};

pub fn run(arguments: &ImportArguments) -> Result<(), VerbError> {
    match (&arguments.output, arguments.data.as_slice()) {
        (_, [data]) if arguments.guess => guess_map(arguments, data),
        (_, several) if arguments.guess => Err(VerbError::GuessOfSeveral(several.len())),
        (Some(bag), _) => import(arguments, bag),
        // The command line excludes this case.
        (None, _) => Ok(()),
    }
}

fn guess_map(arguments: &ImportArguments, data: &Path) -> Result<(), VerbError> {
    // The map beside the data is not an input here, and may be replaced.
    let inputs = Inputs::recording(data).and_all(arguments.sheet.iter().cloned());
    files::check(&[("-o", arguments.output.as_deref())], &inputs, arguments.overwriting)?;
    let model = arguments
        .model
        .as_ref()
        .map(|model| sources::model(&ModelChoice { model: model.clone(), own: OwnEffects::default() }));
    let machine = model.transpose()?.map(|model| model.machine);
    let first = machine.as_ref().and_then(|machine| Some(&*machine.cylinders.first()?.name));
    let cylinder = arguments.cylinder.as_deref().or(first).unwrap_or("arm");
    let sheet = arguments.sheet.as_deref().map(Sheet::read).transpose()?.unwrap_or_default();
    let mut guessed = guess(data, Hints { cylinder, machine: machine.as_ref(), columns: &sheet.columns })?;
    let (input, output) = (std::io::stdin(), std::io::stderr());
    if input.is_terminal() && output.is_terminal() {
        questions::ask(&mut guessed, &mut input.lock(), &mut output.lock())?;
    }
    tell_unsure(&guessed);
    let text = guessed.to_text().map_err(excavator_bags::BagError::from)?;
    files::standard_output(&text)?;
    match &arguments.output {
        Some(path) if path != Path::new("-") => files::write(path, &text, arguments.overwriting),
        _ => Ok(()),
    }
}

fn tell_unsure(guessed: &Guess) {
    let unsure = guessed.signals.iter().filter(|guessed| guessed.confidence == Confidence::Unsure);
    let names: Vec<String> = unsure.map(|guessed| guessed.source.signal.to_string()).collect();
    if !names.is_empty() {
        let what = if names.len() == 1 { "signal, which is" } else { "signals, which are" };
        terminal::remark(&format!("not sure of {} {what} commented out in the map: {}", names.len(), names.join(", ")));
    }
}

fn import(arguments: &ImportArguments, bag: &Path) -> Result<(), VerbError> {
    let inputs = Inputs::recordings(&arguments.data, arguments.map.as_deref()).and_all(arguments.join.iter().cloned());
    files::check_bag(bag, &inputs, arguments.overwriting)?;
    let (recording, report) = read_pieces(&arguments.data, arguments.map.as_deref(), &arguments.join)?;
    for problem in report.problems() {
        match arguments.data.as_slice() {
            [data] => terminal::remark(&format!("{}: {problem}", data.display())),
            _ => terminal::remark(&problem),
        }
    }
    let options = WriteOptions { replace: arguments.overwriting.force, ..WriteOptions::default() };
    write_recording(bag, &recording, &Topics::default(), &options)?;
    let measured: Vec<String> =
        recording.signals().into_iter().filter(|(_, values)| is_measured(values)).map(|(name, _)| name).collect();
    let pieces = if arguments.data.len() > 1 { format!("{} files, ", arguments.data.len()) } else { String::new() };
    print(&format!(
        "Imported {pieces}{} samples in {:.2} s into {}. Signals: {}.",
        recording.len(),
        recording.duration(),
        bag.display(),
        measured.join(", ")
    ));
    print_next(&NextStep::new("see what it is good for", "info").word(bag.display().to_string()));
    Ok(())
}
