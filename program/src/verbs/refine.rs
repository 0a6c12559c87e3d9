//! `excavator refine`

use std::path::Path;

use excavator_identification::refinement::{Additions, Refinement};
use excavator_model::document::to_text;
use excavator_report::refinement_sentence;
use excavator_study::StudyFile;
use excavator_study::results::Refined;

use super::saved_study;
use crate::cli::{ModelChoice, Recordings, RefineArguments};
use crate::error::VerbError;
use crate::files::{self, Inputs, write_json};
use crate::next_step::{NextStep, free, print_next};
use crate::sources;
use crate::terminal::{Progress, Stage, parameter_table, print, remedy_lines, stage_table};

pub fn run(arguments: &RefineArguments) -> Result<(), VerbError> {
    let study = arguments.diagnosis.as_deref().map(StudyFile::read).transpose()?;
    let (choice, mut recordings) = match &study {
        Some(study) => (saved_study::model(study), saved_study::recordings(study)),
        None => (arguments.model_choice(), arguments.recordings()),
    };
    if !arguments.validation.is_empty() {
        recordings.validation.clone_from(&arguments.validation);
    }
    check_outputs(arguments, &choice, &recordings)?;
    let refined = match (study, &arguments.diagnosis) {
        (Some(study), Some(path)) => as_diagnosed(study, path, &recordings, arguments)?,
        _ => searched(arguments, &choice, &recordings)?,
    };
    files::write(&arguments.output, &to_text(&refined.refinement.model)?, arguments.result.overwriting)?;
    if arguments.result.is_shown() {
        show(&refined.refinement);
        end(arguments, &choice, &recordings);
    }
    files::write_page(&refined, arguments.report.as_deref(), arguments.result.overwriting)?;
    write_json(&refined.result(Some(&arguments.output.display().to_string())), &arguments.result)
}

fn check_outputs(arguments: &RefineArguments, choice: &ModelChoice, recordings: &Recordings) -> Result<(), VerbError> {
    let others = [("--report", arguments.report.as_deref()), arguments.result.output()];
    let outputs = [("-o", Some(arguments.output.as_path())), others[0], others[1]];
    let inputs = Inputs::recordings(recordings.bags(), recordings.mapping.map.as_deref());
    let inputs = inputs.and_all(arguments.diagnosis.clone());
    // With --force the output may replace the input model, which keeps its history.
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    files::check(&others, &inputs.and_all(choice.files()), arguments.result.overwriting)
}

fn searched(arguments: &RefineArguments, choice: &ModelChoice, recordings: &Recordings) -> Result<Refined, VerbError> {
    let model = sources::model(choice)?;
    let additions = match (arguments.auto, arguments.propose) {
        (true, true) => Additions::AutoWithLaws,
        (true, false) => Additions::Auto,
        _ => Additions::named(&model, &arguments.add)?,
    };
    let study = recordings.study(model)?;
    let progress = Progress::new();
    Ok(study.refine(&additions, &|what: &str, done: f64| progress.tell(what, done))?)
}

/// Adds the effects of a saved study. Its fits are used, and compared with the validation recordings once more.
fn as_diagnosed(
    study: StudyFile,
    path: &Path,
    recordings: &Recordings,
    arguments: &RefineArguments,
) -> Result<Refined, VerbError> {
    if arguments.validation.is_empty() {
        study.validation.iter().try_for_each(|file| file.check())?;
    }
    let fitted_to: Vec<String> = recordings.identification.iter().map(|path| path.display().to_string()).collect();
    let mut diagnosed = study.diagnosed(path)?;
    let preparation = recordings.mapping.preparation(recordings.extent);
    diagnosed.validation = preparation.recordings(&recordings.validation, &diagnosed.model)?;
    Ok(diagnosed.refine(&fitted_to)?)
}

/// Prints the next command.
fn end(arguments: &RefineArguments, choice: &ModelChoice, recordings: &Recordings) {
    if let Some(bag) = recordings.validation.first() {
        let step = NextStep::new("see every signal of the refined model", "compare").model(&arguments.output, choice);
        let page = arguments.output.with_extension("html");
        let step = step.path("--bag", bag).mapping(&recordings.mapping).extent(recordings.extent);
        print_next(&step.path("--report", &free(&page)));
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
