//! Prints the story on the terminal.

use std::path::{Path, PathBuf};

use excavator_bags::{Topics, write_recording};
use excavator_identification::diagnosis::DiagnosisSettings;
use excavator_identification::refinement::{Additions, refine};
use excavator_model::document::{built_in, to_text};
use excavator_model::recording::Recording;
use excavator_report::{refinement_page, verdict_sentence};
use excavator_study::numbers::number;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rosbag2::WriteOptions;

use super::sealed::Sealed;
use super::{manoeuvre, plant};
use crate::cli::{DemoArguments, Overwriting};
use crate::error::VerbError;
use crate::files::write;
use crate::next_step::{NextStep, print_next};
use crate::terminal::{Progress, Stage, candidate_table, print, stage_table};

/// Every story has its own files.
const NEVER: Overwriting = Overwriting { force: false };
const IDENTIFICATION: &str = "identification";
const VALIDATION: &str = "validation";
const MODEL: &str = "refined-model.toml";
const TRUTH: &str = "true-machine.toml";
const REPORT: &str = "report.html";

/// Runs the demo.
pub(crate) fn run(arguments: &DemoArguments) -> Result<(), VerbError> {
    let folder = free_folder(&arguments.output);
    std::fs::create_dir_all(&folder).map_err(|source| VerbError::Write { path: folder.clone(), source })?;
    let mut generator = ChaCha8Rng::seed_from_u64(arguments.seed);
    let sealed = Sealed::draw(&mut generator)?;
    print("1  A machine: the arm of a 3 t excavator, its parameters up to 20 % off the data sheet, and one physical");
    print("   effect that the model does not know. Which one is sealed until the end.");
    let mut recordings = Vec::new();
    for (name, profile) in [(IDENTIFICATION, manoeuvre::identification()), (VALIDATION, manoeuvre::validation())] {
        let recording = plant::record(&sealed, &profile, &mut generator)?;
        let path = folder.join(name);
        write_recording(&path, &recording, &Topics::default(), &WriteOptions::default())?;
        let (read, _) = excavator_bags::read_recording(&path, &Topics::default())?;
        print(&format!("   recorded {:4.0} s with noisy sensors: {}", read.duration(), path.display()));
        recordings.push(read);
    }
    let (identification, validation) = (&recordings[0], &recordings[1]);

    print("\n2  Fitting the data-sheet model to the recordings, and trying every effect ...");
    let model = built_in("zx30u-arm")?;
    let progress = Progress::new();
    let when = jiff::Timestamp::now().to_string();
    let settings = DiagnosisSettings::default();
    let validation_only: [&Recording; 1] = [validation];
    let refinement =
        refine(&model, &[identification], &validation_only, &Additions::Auto, &settings, &when, &|what, done| {
            progress.tell(what, done);
        })?;
    drop(progress);
    if let Some(diagnosis) = refinement.diagnosis() {
        print(&candidate_table(diagnosis, false).to_string());
        print(&format!("\n3  {}", verdict_sentence(&model, diagnosis)));
    }
    print("\n4  Added, refitted, simulated again on the recording that was never fitted:");
    print(&stage_table(&Stage::of_refinement(&refinement)).to_string());

    print(&format!("\n5  The seal is opened: the hidden effect is {}.", sealed.effect));
    for (name, truth, found, unit) in sealed.opened(&refinement.model) {
        let found = found.map_or("not found".to_string(), number);
        print(&format!("   {name:32} true {:>10}   found {found:>10}   {unit}", number(truth)));
    }
    print(&format!(
        "   the machine's own parameters are found to within {:.2} % (median)",
        100.0 * sealed.base_error(&refinement.model)
    ));
    let model_file = folder.join(MODEL);
    write(&model_file, &to_text(&refinement.model)?, NEVER)?;
    write(&folder.join(TRUTH), &to_text(&sealed.truth)?, NEVER)?;
    let report = folder.join(REPORT);
    write(&report, &refinement_page(&refinement), NEVER)?;
    print(&format!("\nOpen {} to see every signal before and after.", report.display()));
    let step = NextStep::new("simulate the refined model on a recording yourself", "compare");
    print_next(&step.path("--model", &model_file).path("--bag", &folder.join(VALIDATION)));
    Ok(())
}

/// The given folder, or the first of folder-2, folder-3, ... that holds no file of a story yet, so that nothing is overwritten.
fn free_folder(wanted: &Path) -> PathBuf {
    let names = [IDENTIFICATION, VALIDATION, MODEL, TRUTH, REPORT];
    let taken = |path: &Path| names.iter().any(|name| path.join(name).symlink_metadata().is_ok());
    if !taken(wanted) {
        return wanted.to_path_buf();
    }
    let numbered = |number: usize| PathBuf::from(format!("{}-{number}", wanted.display()));
    (2..1000).map(numbered).find(|path| !taken(path)).unwrap_or_else(|| numbered(1000))
}
