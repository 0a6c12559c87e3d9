//! `excavator model new`

pub mod number;
mod questions;
mod sheet;

use std::io::IsTerminal;
use std::path::Path;

use excavator_model::template::model_text;

use crate::cli::NewModelArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::terminal::print;

pub fn run(arguments: &NewModelArguments) -> Result<(), VerbError> {
    files::check(&[("-o", arguments.output.as_deref())], &Inputs::default(), arguments.overwriting)?;
    let answered;
    let arguments = if arguments.drive.is_some() {
        arguments
    } else if std::io::stdin().is_terminal() && std::io::stderr().is_terminal() {
        answered = questions::ask(arguments.clone(), &mut std::io::stdin().lock(), &mut std::io::stderr())?;
        &answered
    } else {
        return Err(VerbError::NewModel(
            "say what drives it (--drive), or answer the questions at a terminal".to_string(),
        ));
    };
    let sheet = sheet::data_sheet(arguments)?;
    let text = model_text(&sheet).map_err(|error| VerbError::NewModel(error.to_string()))?;
    match arguments.output.as_deref() {
        Some(path) if path != Path::new("-") => {
            files::write(path, &text, arguments.overwriting)?;
            print(&format!(
                "A model of {} with starts for the parameters of cylinder \"{}\" is in {}.",
                arguments.name,
                arguments.part,
                path.display()
            ));
            if !sheet.estimated().is_empty() {
                print(&format!("Not given, so estimated in the file: {}.", sheet.estimated().join(", ")));
            }
            print_next(&NextStep::new("try the machine", "model").word("check").word(path.display().to_string()));
            Ok(())
        }
        _ => files::standard_output(&text),
    }
}
