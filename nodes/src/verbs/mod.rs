//! One file per verb.

mod characterise;
mod check_effects;
mod compare;
mod design;
mod diagnose;
mod effects;
mod energy;
mod identify;
mod import;
mod info;
mod manual;
mod model;
mod new_model;
#[cfg(feature = "live")]
mod node;
mod propose;
mod refine;
mod reindex;
mod report;
mod saved_study;
mod simulate;
mod valve_test;

use std::io::{Error, ErrorKind, Write};
use std::sync::OnceLock;

use crate::cli::Verb;
use crate::error::VerbError;
use crate::output::{NextStep, filled};
use crate::ros_words::RosWords;
use crate::terminal;
use crate::verbosity::Verbosity;

/// Runs a verb. `ros` has the arguments after --ros-args.
#[cfg_attr(not(feature = "live"), expect(unused_variables, reason = "only nodes take it"))]
pub fn run(verb: Verb, ros: &RosWords) -> Result<(), VerbError> {
    match verb {
        Verb::Demo(arguments) => crate::demo::run(&arguments),
        Verb::Simulate(arguments) => simulate::run(&arguments),
        Verb::Identify(arguments) => identify::run(&arguments),
        Verb::Compare(arguments) => compare::run(&arguments),
        Verb::Characterise(arguments) => characterise::run(&arguments),
        Verb::Energy(arguments) => energy::run(&arguments),
        Verb::Diagnose(arguments) => diagnose::run(&arguments),
        Verb::Propose(arguments) => propose::run(&arguments),
        Verb::Design(arguments) => design::run(&arguments),
        Verb::Refine(arguments) => refine::run(&arguments),
        Verb::Report(arguments) => report::run(&arguments),
        Verb::Effects(arguments) => effects::run(&arguments),
        Verb::Model(which) => model::run(&which),
        Verb::Info(arguments) => info::run(&arguments),
        #[cfg(feature = "live")]
        Verb::Record(arguments) => crate::record::run(&arguments, &ros.arguments),
        #[cfg(feature = "live")]
        Verb::Play(arguments) => crate::play::run(&arguments, &ros.arguments),
        #[cfg(feature = "live")]
        Verb::Up(arguments) => crate::up::run(&arguments, &ros.words),
        #[cfg(feature = "dashboard")]
        Verb::Dashboard(arguments) => crate::dashboard::run(&arguments, &ros.arguments),
        #[cfg(feature = "live")]
        Verb::Node(which) => node::run(which, &ros.arguments),
        Verb::Import(arguments) => import::run(&arguments),
        #[cfg(feature = "live")]
        Verb::Machine => crate::arm_simulator::run_machine(),
        Verb::Completions { shell } => {
            manual::completions(shell);
            Ok(())
        }
        Verb::Manual(which) => manual::run(&which),
        Verb::Reindex(arguments) => reindex::run(&arguments),
    }
}

/// The first error while printing.
static NOT_PRINTED: OnceLock<Error> = OnceLock::new();

/// Prints text to standard output, made safe for a terminal and wrapped to its width. Prints nothing with `--quiet`.
///
/// A closed pipe is not an error. [`all_was_printed`] reports any other.
pub fn print(text: &str) {
    if Verbosity::chosen() > Verbosity::Quiet {
        write(&filled(text, terminal::width()));
    }
}

/// Prints requested text, such as a schema or a model, without wrapping.
pub fn print_text(text: &str) {
    write(text);
}

/// As [`print()`], only with `--verbose`.
pub fn print_detail(text: &str) {
    if Verbosity::chosen() == Verbosity::Verbose {
        print(text);
    }
}

/// Prints the suggested next command.
pub fn print_next(step: &NextStep) {
    if Verbosity::chosen() > Verbosity::Quiet {
        write(&step.text(terminal::width()));
    }
}

fn write(text: &str) {
    match writeln!(std::io::stdout(), "{}", terminal::text(text)) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => drop(NOT_PRINTED.set(error)),
        _ => (),
    }
}

/// Fails if any output has not reached standard output: a full disk must not end as a success.
pub fn all_was_printed() -> Result<(), VerbError> {
    let flushed = std::io::stdout().flush().err().filter(|error| error.kind() != ErrorKind::BrokenPipe);
    match flushed.map(|error| error.to_string()).or_else(|| NOT_PRINTED.get().map(ToString::to_string)) {
        Some(reason) => Err(VerbError::NotPrinted(reason)),
        None => Ok(()),
    }
}
