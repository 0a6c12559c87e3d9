//! One file per verb.

mod changed;
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
mod position_test;
mod propose;
mod refine;
mod reindex;
mod report;
mod saved_study;
mod simulate;
mod start;
mod valve_test;
mod view;

use crate::cli::Verb;
use crate::error::VerbError;
use crate::ros_words::RosWords;

/// Runs a verb. `ros` has the arguments after --ros-args.
#[cfg_attr(not(feature = "live"), expect(unused_variables, reason = "only nodes take it"))]
pub fn run(verb: Verb, ros: &RosWords) -> Result<(), VerbError> {
    match verb {
        Verb::Demo(arguments) => crate::demo::run(&arguments),
        Verb::Start(arguments) => start::run(&arguments),
        Verb::Simulate(arguments) => simulate::run(&arguments),
        Verb::Identify(arguments) => identify::run(&arguments),
        Verb::Compare(arguments) => compare::run(&arguments),
        Verb::Characterise(arguments) => characterise::run(&arguments),
        Verb::Energy(arguments) => energy::run(&arguments),
        Verb::Changed(arguments) => changed::run(&arguments),
        Verb::Diagnose(arguments) => diagnose::run(&arguments),
        Verb::Propose(arguments) => propose::run(&arguments),
        Verb::Design(arguments) => design::run(&arguments),
        Verb::Refine(arguments) => refine::run(&arguments),
        Verb::Report(arguments) => report::run(&arguments),
        Verb::Effects(arguments) => effects::run(&arguments),
        Verb::Model(which) => model::run(&which),
        Verb::Info(arguments) => info::run(&arguments),
        Verb::View(arguments) => view::run(&arguments),
        #[cfg(feature = "live")]
        Verb::Record(arguments) => node::record(arguments, &ros.arguments),
        #[cfg(feature = "live")]
        Verb::Play(arguments) => node::play(arguments, &ros.arguments),
        #[cfg(feature = "live")]
        Verb::Up(arguments) => crate::up::run(&arguments, &ros.words),
        #[cfg(feature = "dashboard")]
        Verb::Dashboard(arguments) => node::dashboard(arguments, &ros.arguments),
        #[cfg(feature = "live")]
        Verb::Node(which) => node::run(&which, &ros.arguments),
        Verb::Import(arguments) => import::run(&arguments),
        #[cfg(feature = "live")]
        Verb::Machine => node::machine(),
        Verb::Completions { shell } => {
            manual::completions(shell);
            Ok(())
        }
        Verb::Manual(which) => manual::run(&which),
        Verb::Reindex(arguments) => reindex::run(&arguments),
    }
}
