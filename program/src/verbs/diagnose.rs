//! `excavator diagnose`

use std::path::Path;

use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::Diagnosis;
use excavator_identification::search::Unpromising;
use excavator_model::Model;
use excavator_report::{NONE_TRIED, guess_sentence, verdict_sentence};
use excavator_study::StudyFile;
use excavator_study::results::Diagnosed;

use super::saved_study;
use crate::cli::{DiagnoseArguments, ModelChoice, Recordings};
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{Progress, Verbosity, candidate_table, print, print_detail};

pub fn run(arguments: &DiagnoseArguments) -> Result<(), VerbError> {
    let outputs =
        [("--report", arguments.report.as_deref()), ("--save", arguments.save.as_deref()), arguments.result.output()];
    let inputs = Inputs::recordings(arguments.recordings.bags(), arguments.recordings.mapping.map.as_deref())
        .and_all(arguments.model.files());
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let study = arguments.recordings.study(sources::model(&arguments.model)?)?;
    let progress = Progress::new();
    let diagnosed = study.diagnose(&|what: &str, done: f64| progress.tell(what, done))?;
    drop(progress);
    if let Some(path) = &arguments.save {
        let recordings = &arguments.recordings;
        let options = saved_study::options(&arguments.model, recordings);
        let bags = [recordings.identification.as_slice(), recordings.validation.as_slice()];
        files::write(path, &StudyFile::of(&diagnosed, options, bags)?.text()?, arguments.result.overwriting)?;
    }
    if arguments.result.is_shown() {
        show(&diagnosed);
        let step = next(&arguments.model, &arguments.recordings, arguments.save.as_deref(), &diagnosed.diagnosis);
        print_next(&step);
    }
    files::write_told(&diagnosed, arguments.report.as_deref(), &arguments.result)
}

/// The next command, which depends on the verdict, and on whether the study was saved.
pub fn next(model: &ModelChoice, recordings: &Recordings, saved: Option<&Path>, diagnosis: &Diagnosis) -> NextStep {
    let same = |why: &str, verb: &str| NextStep::new(why, verb).same_model(model).recordings(recordings);
    match (diagnosis.verdict.kind, saved) {
        (Kind::Unexplained, _) => same("look for a law of the missing physics", "propose").new_file("-o", "laws.toml"),
        (Kind::Adequate, _) => {
            let step = NextStep::new("see where the energy goes", "energy").same_model(model);
            let bag = recordings.validation.first();
            bag.map_or(step.clone(), |bag| step.path("--bag", bag).mapping(&recordings.mapping))
        }
        (Kind::MissingEffect, Some(saved)) => {
            NextStep::new("add it to the model", "refine").path("--diagnosis", saved).new_file("-o", "refined.toml")
        }
        (Kind::MissingEffect, None) => {
            same("add it to the model", "refine").word("--auto").new_file("-o", "refined.toml")
        }
    }
}

/// Prints a diagnosis with its guess and its missing power.
pub fn show(diagnosed: &Diagnosed) {
    show_diagnosis(&diagnosed.model, &diagnosed.diagnosis);
    diagnosed.guess.iter().for_each(|guess| print(&guess_sentence(guess)));
    for (source, found) in &diagnosed.missing {
        found.iter().for_each(|one| print_detail(&format!("Energy in {source}: {}", one.sentence)));
    }
}

/// Smallest share of the residual that gets a line.
const LEAST_SHARE: f64 = 0.05;

/// Prints a diagnosis.
fn show_diagnosis(model: &Model, diagnosis: &Diagnosis) {
    print(&verdict_sentence(model, diagnosis));
    if diagnosis.tried() == 0 {
        print(NONE_TRIED);
    } else {
        let detail = Verbosity::chosen() == Verbosity::Verbose;
        print(&candidate_table(diagnosis, detail).to_string());
    }
    if !diagnosis.unpromising.is_empty() {
        let same =
            |effect: &Unpromising| diagnosis.unpromising.iter().filter(|other| other.effect == effect.effect).count();
        // The place is shown only if the effect appears at several.
        let names: Vec<String> = diagnosis
            .unpromising
            .iter()
            .map(|effect| match same(effect) {
                1 => effect.effect.to_string(),
                _ => effect.name.clone(),
            })
            .collect();
        print_detail(&format!("Dropped in the screening: {}.", names.join(", ")));
    }
    for (name, error) in &diagnosis.failed {
        print(&format!("{name} could not be tried: {error}"));
    }
    if diagnosis.map.is_empty() {
        print("Where the fitted model fails cannot be located: no equation has all its signals measured.");
        return;
    }
    print_detail("Where the fitted model fails (share of the squared residual, in units of sensor noise):");
    for share in diagnosis.map.iter().filter(|share| share.share_of_residual >= LEAST_SHARE).take(6) {
        let (residual, time) = (100.0 * share.share_of_residual, 100.0 * share.share_of_time);
        print_detail(&format!("  {:4.0} %  {}, {} ({time:.0} % of the time)", residual, share.equation, share.regime));
    }
}
