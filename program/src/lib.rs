//! The program `excavator`: verbs on recordings, the nodes behind verbs, and the simulated machine of its demo.

mod cli;
pub mod demo;
mod error;
mod files;
mod manual;
mod missing;
mod next_step;
mod ros_words;
mod sources;
mod terminal;
#[cfg(feature = "live")]
mod up;
mod verbs;

use std::process::ExitCode;

use clap::FromArgMatches;
use excavator_model::display::PressureUnit;

/// Runs the command line of this process.
pub fn run_command_line() -> ExitCode {
    let all: Vec<String> = std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
    let outcome = ros_words::RosWords::split(&all).and_then(|(ros, words)| {
        let parsed = manual::command().try_get_matches_from(&words);
        // Only help and error messages contain a usage.
        let parsed = parsed.or_else(|_| manual::command_within(terminal::width()).try_get_matches_from(words));
        let arguments = parsed.and_then(|found| cli::Arguments::from_arg_matches(&found));
        let arguments = arguments.unwrap_or_else(|refusal| refuse(&refusal));
        arguments.verbosity().choose();
        PressureUnit::from(arguments.units).show();
        verbs::run(arguments.verb, &ros)?;
        terminal::all_was_printed()
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            terminal::complain(&format!("excavator: {error}"), error.excerpt());
            ExitCode::from(error.exit_code())
        }
    }
}

/// Prints the error in the command line, or the help, and exits. The text may contain foreign file names.
fn refuse(refusal: &clap::Error) -> ! {
    if let Some(reason) = missing::reason(refusal) {
        terminal::complain(&format!("excavator: {reason}"), "");
        std::process::exit(refusal.exit_code());
    }
    let is_odd = |word: std::ffi::OsString| terminal::printable(&word.to_string_lossy()) != word.to_string_lossy();
    if std::env::args_os().any(is_odd) {
        // Without colours: a name could hide escape sequences among them.
        eprint!("{}", terminal::text(&refusal.render().to_string()));
        std::process::exit(refusal.exit_code());
    }
    refusal.exit()
}
