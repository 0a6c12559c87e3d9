//! The program `excavator`: verbs over recordings, and the made-up machine of its demo.

mod cli;
pub mod demo;
mod error;
mod output;
mod sources;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

/// Runs the command line of this process.
pub fn run_command_line() -> ExitCode {
    let arguments = cli::Arguments::parse();
    match verbs::run(arguments.verb) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("excavator: {error}");
            ExitCode::from(1)
        }
    }
}
