//! One file per verb.

mod compare;
mod diagnose;
mod effects;
mod identify;
mod info;
mod refine;
mod simulate;

use crate::cli::Verb;
use crate::error::VerbError;

/// Runs a verb.
pub fn run(verb: Verb) -> Result<(), VerbError> {
    match verb {
        Verb::Demo(arguments) => crate::demo::run(&arguments),
        Verb::Simulate(arguments) => simulate::run(&arguments),
        Verb::Identify(arguments) => identify::run(&arguments),
        Verb::Compare(arguments) => compare::run(&arguments),
        Verb::Diagnose(arguments) => diagnose::run(&arguments),
        Verb::Refine(arguments) => refine::run(&arguments),
        Verb::Effects(arguments) => effects::run(&arguments),
        Verb::Info(arguments) => info::run(&arguments),
    }
}

/// Prints to standard output; a closed pipe is not an error of ours.
pub fn print(text: &str) {
    use std::io::Write;
    let _ = writeln!(std::io::stdout(), "{text}");
}
