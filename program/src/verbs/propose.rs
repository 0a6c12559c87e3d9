//! `excavator propose`

use excavator_identification::proposal::{Finding, Proposal, ProposalVerdict, Proposals};
use excavator_model::Model;
use excavator_report::proposal_sentence;
use excavator_study::results::Outcome;

use crate::cli::ProposeArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{Progress, print, proposal_table, remark};

pub fn run(arguments: &ProposeArguments) -> Result<(), VerbError> {
    let outputs =
        [("-o", arguments.output.as_deref()), ("--report", arguments.report.as_deref()), arguments.result.output()];
    let inputs = Inputs::recordings(arguments.recordings.bags(), arguments.recordings.mapping.map.as_deref())
        .and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let study = arguments.recordings.study(model)?;
    let progress = Progress::new();
    let proposed = study.propose(&|what: &str, done: f64| progress.tell(what, done))?;
    drop(progress);
    if let Some(path) = &arguments.output {
        match proposed.file()? {
            Some(laws) => files::write(path, &laws, arguments.result.overwriting)?,
            None => remark(&format!("{} is not written: no law is proposed", path.display())),
        }
    }
    if arguments.result.is_shown() {
        show(arguments, &proposed.model, &proposed.found);
    }
    files::write_told(&proposed, arguments.report.as_deref(), &arguments.result)
}

/// Prints proposals, with the suggested next command.
fn show(arguments: &ProposeArguments, model: &Model, found: &Proposals) {
    print(&proposal_sentence(model, found));
    if !found.proposals.is_empty() {
        print(&proposal_table(found).to_string());
    }
    if !found.survey.rows.is_empty() {
        let list = |findings: &[Finding]| {
            let each = findings.iter().take(MOST_FINDINGS);
            each.map(|one| format!("{} {:.0} %", one.name, 100.0 * one.share)).collect::<Vec<_>>().join(", ")
        };
        print(&format!(
            "Predicted improvement of the best single term in each equation, relative to the best of all: {}.",
            list(&found.survey.rows)
        ));
        print(&format!("Predicted improvement lost without each variable: {}.", list(&found.survey.variables)));
    }
    let Some(first) = found.proposals.first() else { return };
    let Some(file) = &arguments.output else {
        print_next(
            &NextStep::new("keep the laws", "propose")
                .same_model(&arguments.model)
                .recordings(&arguments.recordings)
                .new_file("-o", "laws.toml"),
        );
        return;
    };
    let name = |proposal: &Proposal| format!("{}@{}", proposal.text.name, proposal.place);
    let with_laws =
        |why: &str, verb: &str| NextStep::new(why, verb).same_model(&arguments.model).path("--catalogue", file);
    let why =
        if first.beside.is_empty() { "add the first law" } else { "add the first law and what it needs beside it" };
    // Effects that the hypothesis of the law has besides are added first, as in the fit of its numbers.
    let step = first.beside.iter().fold(with_laws(why, "refine").word("--add"), |step, other| step.word(other));
    print_next(&step.word(name(first)).recordings(&arguments.recordings).new_file("-o", "refined.toml"));
    let tied: Vec<String> = found.proposals.iter().filter(|one| one.is_in_set).map(name).take(MOST_TIED).collect();
    if found.kind == ProposalVerdict::Law && found.diagnosis.verdict.set.len() > 1 {
        let step =
            with_laws("or design a manoeuvre that separates them", "design").word("--between").word(tied.join(","));
        print_next(&step.new_file("-o", "profile.toml"));
    }
}

/// Most rows and variables that are printed.
const MOST_FINDINGS: usize = 5;

/// Most laws in one design of a manoeuvre.
const MOST_TIED: usize = 3;
