//! `excavator design`

use std::path::Path;

use excavator_identification::design::{ParameterDesign, Plan, SeparationDesign};
use excavator_study::diagnosis_file::DiagnosisFile;
use excavator_study::numbers::number;
use excavator_study::results::{DesignOrder, Determined, Outcome, Separated};
use excavator_study::sentences::{determination_sentence, separation_sentence};

use crate::cli::DesignArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs, write, write_json};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::{Progress, pair_table, print, print_detail};

pub fn run(arguments: &DesignArguments) -> Result<(), VerbError> {
    let outputs = [("-o", Some(arguments.output.as_path())), arguments.result.output()];
    let inputs = arguments.diagnosis.iter().fold(Inputs::default().and_all(arguments.model.files()), Inputs::and);
    files::check(&outputs, &inputs, arguments.result.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let diagnosis = arguments.diagnosis.as_deref().map(DiagnosisFile::read).transpose()?;
    let order = DesignOrder {
        between: arguments.between.clone(),
        duration: arguments.duration,
        stroke_margin: arguments.stroke_margin,
        highest_pressure: arguments.highest_pressure,
    };
    let progress = Progress::new();
    let tell = |what: &str, done: f64| progress.tell(what, done);
    match &arguments.parameter {
        Some(name) => {
            let found = Determined::of(&model, name, &order, diagnosis.as_ref(), &tell)?;
            drop(progress);
            for_parameter(arguments, &found)
        }
        None => {
            let found = Separated::of(&model, &order, diagnosis.as_ref(), &tell)?;
            drop(progress);
            between_rivals(arguments, &found)
        }
    }
}

fn between_rivals(arguments: &DesignArguments, found: &Separated) -> Result<(), VerbError> {
    let design = found.design();
    let written = write_profile(arguments, found)?;
    if arguments.result.is_shown() {
        show(design, written, arguments);
    }
    write_json(&found.result(name_of(written).as_deref()), &arguments.result)?;
    if written.is_some() { Ok(()) } else { Err(VerbError::NothingSeparates(sentence(design))) }
}

/// Writes the profile, if one was found. Returns its file.
fn write_profile<'a>(arguments: &'a DesignArguments, found: &impl Outcome) -> Result<Option<&'a Path>, VerbError> {
    let Some(profile) = found.file()? else { return Ok(None) };
    write(&arguments.output, &profile, arguments.result.overwriting)?;
    Ok(Some(&arguments.output))
}

/// The profile file as named in the result.
fn name_of(written: Option<&Path>) -> Option<String> {
    written.map(|path| path.display().to_string())
}

/// A sentence on the pairs that are not separated.
fn sentence(design: &SeparationDesign) -> String {
    let tied = design.pairs.iter().filter(|pair| !pair.separated);
    let each = tied.map(|pair| {
        format!(
            "{} and {} are not separated (expected improvement {:.2}, {:.1} standard errors)",
            pair.first, pair.second, pair.expected_improvement, pair.expected_significance
        )
    });
    each.collect::<Vec<_>>().join("; ")
}

fn show(design: &SeparationDesign, written: Option<&Path>, arguments: &DesignArguments) {
    let (all, within) = design.manoeuvres;
    print(&separation_sentence(design));
    print(&pair_table(design).to_string());
    if !design.all_separated() && design.any_separated() {
        print(&format!("{}.", sentence(design)));
    }
    show_plan(&design.plan);
    print_detail(&format!("{within} of {all} manoeuvres stay within the limits with every rival."));
    if let Some(path) = written {
        show_use(path, arguments);
    }
}

fn show_plan(plan: &Plan) {
    print(&format!("{:.1} s, from rest at mid-stroke and back:", plan.duration));
    for (name, start) in &plan.chosen {
        print(&format!("  {start:6.1} s  {name}"));
    }
}

fn show_use(path: &Path, arguments: &DesignArguments) {
    print(&format!("The profile is in {}. Run it twice: one recording to fit, one to judge.", path.display()));
    let step = NextStep::new("make its commands a bag", "simulate").same_model(&arguments.model);
    print_next(&step.path("--input", path).new_file("-o", "commands"));
}

fn for_parameter(arguments: &DesignArguments, found: &Determined) -> Result<(), VerbError> {
    let design = found.design();
    let written = write_profile(arguments, found)?;
    if arguments.result.is_shown() {
        show_parameter(design);
        if let Some(path) = written {
            show_use(path, arguments);
        }
    }
    write_json(&found.result(name_of(written).as_deref()), &arguments.result)?;
    if written.is_some() {
        return Ok(());
    }
    Err(VerbError::NothingSeparates(format!(
        "the expected standard error of {} = {} {} is {} (a fit to the trial run reports {})",
        design.name,
        number(design.value),
        design.unit,
        number(design.expected_error),
        number(design.trial_run_error)
    )))
}

fn show_parameter(design: &ParameterDesign) {
    let (all, within) = design.manoeuvres;
    print(&determination_sentence(design));
    print_detail(&format!("{within} of {all} manoeuvres stay within the limits."));
    let line = |what: &str, error: f64| {
        let share = 100.0 * error / design.value.abs();
        print(&format!("  {what:52} {:>10} {}  ({share:.2} %)", number(error), design.unit));
    };
    print(&format!("Standard error of {} = {} {}:", design.name, number(design.value), design.unit));
    if let Some(given) = design.given_error {
        line("as the model says", given);
    }
    line("moderate sines as long, sensor noise alone", design.sine_error);
    line("this profile, sensor noise alone", design.expected_error);
    line("this profile, as a fit to a trial run reports it", design.trial_run_error);
    show_plan(&design.plan);
}
