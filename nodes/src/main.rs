//! `excavator`: which physics is your hydraulic arm's model missing?

mod cli;
mod demo;
mod error;
mod output;
mod sources;
mod verbs;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let arguments = cli::Arguments::parse();
    match verbs::run(arguments.verb) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("excavator: {error}");
            ExitCode::from(1)
        }
    }
}
