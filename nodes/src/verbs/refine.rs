//! `excavator refine`

use std::path::Path;

use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::refinement::{Additions, Refinement, refine};
use excavator_identification::report::{refinement_page, refinement_sentence};
use excavator_identification::search::Addition;
use excavator_model::Model;
use excavator_model::document::to_text;
use excavator_model::recording::Recording;

use super::print;
use crate::cli::RefineArguments;
use crate::error::VerbError;
use crate::output::{Progress, parameter_table, refinement_json, remedy_lines, step_table, write_json};
use crate::outputs::{self, Inputs};
use crate::sources;

pub fn run(arguments: &RefineArguments) -> Result<(), VerbError> {
    let others = [("--report", arguments.report.as_deref()), ("--json", arguments.json.json.as_deref())];
    let outputs = [("-o", Some(arguments.output.as_path())), others[0], others[1]];
    let inputs = Inputs::recordings(arguments.recordings.bags(), arguments.recordings.mapping.map.as_deref());
    // With --force the model may become its own successor: it has a history.
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    outputs::check(&others, &inputs.and_all(arguments.model.files()), arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let additions = match (arguments.auto, arguments.propose) {
        (true, true) => Additions::AutoWithLaws,
        (true, false) => Additions::Auto,
        _ => named(&model, &arguments.add)?,
    };
    let (identification, validation) = sources::fitted_and_judging(&arguments.recordings, &model)?;
    let identification: Vec<&Recording> = identification.iter().collect();
    let validation: Vec<&Recording> = validation.iter().collect();
    let progress = Progress::new();
    let settings = DiagnosisSettings::default();
    let when = jiff::Timestamp::now().to_string();
    let refinement = refine(&model, &identification, &validation, &additions, &settings, &when, &|what, done| {
        progress.tell(what, done);
    })?;
    drop(progress);
    outputs::write(&arguments.output, &to_text(&refinement.model)?, arguments.overwriting)?;
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&refinement);
        print(&format!("written: {}", arguments.output.display()));
    }
    if let Some(path) = &arguments.report {
        outputs::write(path, &refinement_page(&refinement), arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &refinement_json(&refinement, &arguments.output), arguments.overwriting)?;
    }
    Ok(())
}

/// What the user named, each at every place it can act unless a place is given.
fn named(model: &Model, names: &[String]) -> Result<Additions, VerbError> {
    let mut additions = Vec::new();
    for name in names {
        for (physics, site) in model.parse_addition(name)? {
            let addition = Addition { physics, site };
            if additions.contains(&addition) {
                return Err(VerbError::AddedTwice(name.clone()));
            }
            additions.push(addition);
        }
    }
    Ok(Additions::Named(additions))
}

/// Prints a refinement for people.
pub fn show(refinement: &Refinement) {
    print(&refinement_sentence(refinement));
    print(&step_table(refinement).to_string());
    if let Some(last) = refinement.steps.last() {
        print(&parameter_table(&last.fit.model, &last.fit.fitted).to_string());
        remedy_lines(&last.fit.model, &last.fit.fitted).iter().for_each(|line| print(line));
    }
}
