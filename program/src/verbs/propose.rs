//! `excavator propose`

use std::path::{Path, PathBuf};

use excavator_identification::proposal::{Finding, Proposal, ProposalVerdict, Proposals};
use excavator_model::Model;
use excavator_report::proposal_sentence;
use excavator_study::results::Outcome;

use crate::cli::ProposeArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{Progress, print, proposal_table};

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
    if arguments.result.is_shown() {
        show(arguments, &proposed.model, &proposed.found);
    }
    if let Some(path) = &arguments.output
        && let Some(laws) = proposed.file()?
    {
        files::write(path, &laws, arguments.result.overwriting)?;
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
    let file = arguments.output.clone().unwrap_or_else(|| PathBuf::from("laws.toml"));
    let name = |proposal: &Proposal| format!("{}@{}", proposal.text.name, proposal.place);
    if arguments.output.is_none() {
        print_next(
            &NextStep::new("keep the laws", "propose")
                .same_model(&arguments.model)
                .recordings(&arguments.recordings)
                .path("-o", &file),
        );
        return;
    }
    let with_laws =
        |why: &str, verb: &str| NextStep::new(why, verb).same_model(&arguments.model).path("--catalogue", &file);
    print_next(
        &with_laws("add the first law", "refine")
            .word("--add")
            .word(name(first))
            .recordings(&arguments.recordings)
            .path("-o", Path::new("refined.toml")),
    );
    let tied: Vec<String> = found.proposals.iter().filter(|one| one.is_in_set).map(name).take(MOST_TIED).collect();
    if found.kind == ProposalVerdict::Law && found.diagnosis.verdict.set.len() > 1 {
        let step =
            with_laws("or design a manoeuvre that separates them", "design").word("--between").word(tied.join(","));
        print_next(&step.path("-o", Path::new("profile.toml")));
    }
}

/// Most rows and variables that are printed.
const MOST_FINDINGS: usize = 5;

/// Most laws in one design of a manoeuvre.
const MOST_TIED: usize = 3;
