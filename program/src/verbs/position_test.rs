//! `excavator model position`

use excavator_study::json_text;
use excavator_study::position_test::{PositionColumns, position_lines};

use crate::cli::PositionTestArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::terminal::print;

pub fn run(arguments: &PositionTestArguments) -> Result<(), VerbError> {
    let tables = || arguments.identification.iter().chain(&arguments.validation);
    files::check(&[arguments.result.output()], &Inputs::recordings(tables(), None), arguments.result.overwriting)?;
    let columns = PositionColumns { reference: arguments.reference.clone(), position: arguments.position.clone() };
    let fit = columns.fit(&arguments.identification, &arguments.validation)?;
    if arguments.result.is_shown() {
        position_lines(&fit).iter().for_each(|line| print(line));
    }
    match &arguments.result.json {
        Some(json) => files::write(json, &json_text(&fit)?, arguments.result.overwriting),
        None => Ok(()),
    }
}
