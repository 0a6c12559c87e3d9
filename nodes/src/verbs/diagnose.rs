//! `excavator diagnose`

use std::path::Path;

use excavator_identification::decision::Kind;
use excavator_identification::diagnosis::{Diagnosis, DiagnosisSettings, diagnose};
use excavator_identification::energy::ledgers;
use excavator_identification::proposal::guess_for;
use excavator_identification::refinement::refinement_of;
use excavator_identification::results;
use excavator_identification::search::Unpromising;
use excavator_identification::validation::{Comparison, compare};
use excavator_model::Model;
use excavator_model::recording::Recording;
use excavator_report::{NONE_TRIED, diagnosis_page, guess_sentence, verdict_sentence};

use super::{print, print_detail, print_next};
use crate::cli::DiagnoseArguments;
use crate::error::VerbError;
use crate::output::{NextStep, Progress, candidate_table, write_json};
use crate::outputs::{self, Inputs};
use crate::saved_diagnosis::SavedDiagnosis;
use crate::sources;
use crate::verbosity::Verbosity;

pub fn run(arguments: &DiagnoseArguments) -> Result<(), VerbError> {
    let outputs = [
        ("--report", arguments.report.as_deref()),
        ("--save", arguments.save.as_deref()),
        ("--scores", arguments.scores.as_deref()),
        ("--json", arguments.json.json.as_deref()),
    ];
    let inputs = Inputs::recordings(arguments.recordings.bags(), arguments.recordings.mapping.map.as_deref())
        .and_all(arguments.model.files());
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let (identification, validation) = sources::fitted_and_judging(&arguments.recordings, &model)?;
    let identification: Vec<&Recording> = identification.iter().collect();
    let validation: Vec<&Recording> = validation.iter().collect();
    let progress = Progress::new();
    let settings = DiagnosisSettings::default();
    let mut diagnosis =
        diagnose(&model, &identification, &validation, &settings, &|what, done| progress.tell(what, done))?;
    drop(progress);
    if let Some(path) = &arguments.save {
        let when = jiff::Timestamp::now().to_string();
        let refinement = refinement_of(&model, &diagnosis, &identification, &validation, &settings, &when)?;
        outputs::write(path, &SavedDiagnosis::of(&refinement, &arguments.recordings)?.text()?, arguments.overwriting)?;
        // A refinement leaves out what is superfluous in the fits: its numbers are those that will be seen again.
        if let Some(found) = refinement.diagnosis() {
            diagnosis.errors.clone_from(&found.errors);
        }
    }
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&model, &diagnosis);
    }
    let guess = guess_for(&diagnosis, &identification, &validation);
    if arguments.json.json.as_deref() != Some(Path::new("-"))
        && let Some(guess) = &guess
    {
        print(&guess_sentence(guess));
    }
    let missing = ledgers(&diagnosis.given().fit.model, &validation);
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        for (source, found) in &missing {
            found.iter().for_each(|one| print_detail(&format!("Energy in {source}: {}", one.sentence)));
        }
        print_next(&next(arguments, &diagnosis));
    }
    if let Some(path) = &arguments.scores {
        let text = serde_json::to_string(&diagnosis.scores).map_err(VerbError::from)?;
        outputs::write(path, &text, arguments.overwriting)?;
    }
    if let Some(path) = &arguments.report {
        let comparisons = validation
            .iter()
            .map(|recording| compare(&diagnosis.given().fit.model, recording))
            .collect::<Result<Vec<Comparison>, _>>()?;
        outputs::write(path, &diagnosis_page(&model, &diagnosis, &comparisons, &missing), arguments.overwriting)?;
    }
    if let Some(path) = &arguments.json.json {
        let result = results::Diagnosis::of(&model, &diagnosis, guess.as_ref(), &missing);
        write_json(path, &result, arguments.overwriting)?;
    }
    Ok(())
}

/// What a verdict asks for.
fn next(arguments: &DiagnoseArguments, diagnosis: &Diagnosis) -> NextStep {
    let same =
        |why: &str, verb: &str| NextStep::new(why, verb).same_model(&arguments.model).recordings(&arguments.recordings);
    match (diagnosis.verdict.kind, &arguments.save) {
        (Kind::Unexplained, _) => {
            same("look for a law of the missing physics", "propose").path("-o", Path::new("laws.toml"))
        }
        (Kind::Adequate, _) => {
            let step = NextStep::new("see where the energy goes", "energy").same_model(&arguments.model);
            let bag = arguments.recordings.validation.first();
            bag.map_or(step.clone(), |bag| step.path("--bag", bag).mapping(&arguments.recordings.mapping))
        }
        (Kind::MissingEffect, Some(saved)) => NextStep::new("add it to the model", "refine")
            .path("--diagnosis", saved)
            .path("-o", Path::new("refined.toml")),
        (Kind::MissingEffect, None) => {
            same("add it to the model", "refine").word("--auto").path("-o", Path::new("refined.toml"))
        }
    }
}

/// Shares of the residual that are worth a line.
const LEAST_SHARE: f64 = 0.05;

/// Prints a diagnosis for people.
pub fn show(model: &Model, diagnosis: &Diagnosis) {
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
        // The place only where it tells two apart.
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
