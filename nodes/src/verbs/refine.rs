//! `excavator refine`

use std::path::Path;

use excavator_identification::refinement::{Additions, Refinement};
use excavator_identification::results;
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::document::to_text;
use excavator_model::recording::Recording;
use excavator_report::refinement_sentence;
use excavator_workbench::results::Refined;

use super::{print, print_next};
use crate::cli::{ModelChoice, Recordings, RefineArguments};
use crate::error::VerbError;
use crate::output::{NextStep, Progress, Stage, parameter_table, remedy_lines, stage_table, write_json};
use crate::outputs::{self, Inputs};
use crate::saved_diagnosis::SavedDiagnosis;
use crate::sources;

pub fn run(arguments: &RefineArguments) -> Result<(), VerbError> {
    match &arguments.diagnosis {
        Some(path) => as_diagnosed(path, arguments),
        None => searched(arguments),
    }
}

fn searched(arguments: &RefineArguments) -> Result<(), VerbError> {
    let (choice, recordings) = (arguments.model_choice(), arguments.recordings());
    let others = [("--report", arguments.report.as_deref()), ("--json", arguments.json.json.as_deref())];
    let outputs = [("-o", Some(arguments.output.as_path())), others[0], others[1]];
    let inputs = Inputs::recordings(recordings.bags(), recordings.mapping.map.as_deref());
    // With --force the output may replace the input model, which keeps its history.
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    outputs::check(&others, &inputs.and_all(choice.files()), arguments.overwriting)?;
    let model = sources::model(&choice)?;
    let additions = match (arguments.auto, arguments.propose) {
        (true, true) => Additions::AutoWithLaws,
        (true, false) => Additions::Auto,
        _ => Additions::named(&model, &arguments.add)?,
    };
    let (identification, validation) = sources::fitted_and_judging(&recordings, &model)?;
    let identification: Vec<&Recording> = identification.iter().collect();
    let validation: Vec<&Recording> = validation.iter().collect();
    let progress = Progress::new();
    let tell = |what: &str, done: f64| progress.tell(what, done);
    let refined = Refined::of(&model, &identification, &validation, &additions, &tell)?;
    drop(progress);
    outputs::write(&arguments.output, &to_text(&refined.refinement.model)?, arguments.overwriting)?;
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&refined.refinement);
        end(arguments, &choice, &recordings);
    }
    outputs::write_told(&refined, arguments.report.as_deref(), None, arguments.overwriting)?;
    if let Some(path) = &arguments.json.json {
        let written = arguments.output.display().to_string();
        write_json(path, &refined.result(Some(&written)), arguments.overwriting)?;
    }
    Ok(())
}

/// Adds the effects of a saved diagnosis. Its fits are used, and simulated once more.
fn as_diagnosed(path: &Path, arguments: &RefineArguments) -> Result<(), VerbError> {
    let saved = SavedDiagnosis::read(path)?;
    let mut recordings = saved.recordings();
    if !arguments.validation.is_empty() {
        recordings.validation.clone_from(&arguments.validation);
    }
    let outputs = [("-o", Some(arguments.output.as_path())), ("--json", arguments.json.json.as_deref())];
    let inputs = Inputs::recordings(recordings.bags(), recordings.mapping.map.as_deref()).and_all([path.to_path_buf()]);
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    let (given, refined) = (saved.given()?, saved.refined()?);
    let validation =
        sources::telling_recordings(&recordings.validation, recordings.extent, &recordings.mapping, &given)?;
    let compared = |model: &Model| {
        validation
            .iter()
            .map(|recording| Ok(compare(model, recording)?))
            .collect::<Result<Vec<Comparison>, VerbError>>()
    };
    // A model with the values of a data sheet may fail to simulate.
    let as_given = compared(&given).unwrap_or_default();
    let steps = saved.steps()?.into_iter().map(|step| Ok((step.added, compared(&step.model)?)));
    let steps = steps.collect::<Result<Vec<_>, VerbError>>()?;
    let steps = || steps.iter().map(|(added, comparisons)| (added.as_deref(), comparisons.as_slice()));
    outputs::write(&arguments.output, &to_text(&refined)?, arguments.overwriting)?;
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        print(&saved.sentence);
        print(&stage_table(&Stage::all(&as_given, steps())).to_string());
        print(&parameter_table(&refined, &refined.unknown_parameters()).to_string());
        end(arguments, &ModelChoice { model: String::new(), own: arguments.own.clone() }, &recordings);
    }
    if let Some(file) = &arguments.json.json {
        let written = arguments.output.display().to_string();
        write_json(file, &results::Refinement::of(saved.verdict, steps(), Some(&written)), arguments.overwriting)?;
    }
    Ok(())
}

/// Prints where the model is, and the next command.
fn end(arguments: &RefineArguments, choice: &ModelChoice, recordings: &Recordings) {
    print(&format!("written: {}", arguments.output.display()));
    if let Some(bag) = recordings.validation.first() {
        let step = NextStep::new("see every signal of the refined model", "compare").model(&arguments.output, choice);
        let page = arguments.output.with_extension("html");
        print_next(&step.path("--bag", bag).mapping(&recordings.mapping).path("--report", &page));
    }
}

/// Prints a refinement.
fn show(refinement: &Refinement) {
    print(&refinement_sentence(refinement));
    print(&stage_table(&Stage::of_refinement(refinement)).to_string());
    if let Some(last) = refinement.steps.last() {
        print(&parameter_table(&last.fit.model, &last.fit.fitted).to_string());
        remedy_lines(&last.fit.model, &last.fit.fitted).iter().for_each(|line| print(line));
    }
}
