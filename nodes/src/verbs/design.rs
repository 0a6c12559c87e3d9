//! `excavator design`

use std::path::Path;

use excavator_identification::design::{
    DesignSettings, ParameterDesign, Plan, Rival, SeparationDesign, determine, separate,
};
use excavator_identification::results;
use excavator_model::Model;
use excavator_workbench::diagnosis_file::DiagnosisFile;
use excavator_workbench::sentences::{
    determination_profile, determination_sentence, separation_profile, separation_sentence,
};

use super::{print, print_detail, print_next};
use crate::cli::DesignArguments;
use crate::error::VerbError;
use crate::output::{NextStep, Progress, number, pair_table, write_json};
use crate::outputs::{self, Inputs, write};
use crate::sources;

pub fn run(arguments: &DesignArguments) -> Result<(), VerbError> {
    let outputs = [("-o", Some(arguments.output.as_path())), ("--json", arguments.json.json.as_deref())];
    let inputs = arguments.diagnosis.iter().fold(Inputs::default().and_all(arguments.model.files()), Inputs::and);
    outputs::check(&outputs, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let diagnosis = arguments.diagnosis.as_deref().map(DiagnosisFile::read).transpose()?;
    let model = diagnosis.as_ref().map_or_else(|| Ok(model.clone()), |file| file.with_nuisances(&model))?;
    let mut settings = DesignSettings::usual(&model.machine);
    settings.duration = arguments.duration;
    settings.limits.stroke_margin = arguments.stroke_margin;
    settings.limits.highest_pressure = arguments.highest_pressure;
    if let Some(file) = &diagnosis {
        file.noise_into(&mut settings.sensors);
    }
    match &arguments.parameter {
        Some(name) => for_parameter(arguments, &model, name, diagnosis.as_ref(), &settings),
        None => between_rivals(arguments, &model, diagnosis.as_ref(), &settings),
    }
}

fn between_rivals(
    arguments: &DesignArguments,
    model: &Model,
    diagnosis: Option<&DiagnosisFile>,
    settings: &DesignSettings,
) -> Result<(), VerbError> {
    let names = match (arguments.between.as_slice(), diagnosis) {
        ([], Some(file)) => file.tied()?,
        (names, _) => names.to_vec(),
    };
    let mut rivals = Rival::named(model, &names)?;
    // Only values of all rivals from one diagnosis make them as alike as the recordings did.
    let fitted = diagnosis.is_some_and(|file| rivals.iter().all(|rival| file.has(&rival.name)));
    if let Some(file) = diagnosis {
        rivals.iter_mut().for_each(|rival| rival.set(file.values(&rival.name)));
    }
    let progress = Progress::new();
    let design = separate(rivals, fitted, settings, &|what, done| progress.tell(what, done))?;
    drop(progress);
    let written = design.any_separated().then_some(arguments.output.as_path());
    if let Some(path) = written {
        write(path, &separation_profile(model, &design)?, arguments.overwriting)?;
    }
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show(&design, written, arguments);
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &results::Separation::of(&design, name_of(written).as_deref()), arguments.overwriting)?;
    }
    if written.is_some() { Ok(()) } else { Err(VerbError::NothingSeparates(sentence(&design))) }
}

/// The profile file as a result names it.
fn name_of(written: Option<&Path>) -> Option<String> {
    written.map(|path| path.display().to_string())
}

/// The pairs that are not separated, in words.
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
    print_next(&step.path("--input", path).path("-o", Path::new("commands")));
}

fn for_parameter(
    arguments: &DesignArguments,
    model: &Model,
    name: &str,
    diagnosis: Option<&DiagnosisFile>,
    settings: &DesignSettings,
) -> Result<(), VerbError> {
    let mut rival = Rival { name: "none".into(), addition: None, model: model.clone() };
    for one in &arguments.between {
        for more in Rival::named(&rival.model, std::slice::from_ref(one))? {
            rival = more;
        }
    }
    if let Some(file) = diagnosis {
        rival.set(file.values(&rival.name));
    }
    let model = rival.model;
    let progress = Progress::new();
    let design = determine(&model, name, settings, &|what, done| progress.tell(what, done))?;
    drop(progress);
    let written = design.determined.then_some(arguments.output.as_path());
    if let Some(path) = written {
        write(path, &determination_profile(&model, &design)?, arguments.overwriting)?;
    }
    if arguments.json.json.as_deref() != Some(Path::new("-")) {
        show_parameter(&design);
        if let Some(path) = written {
            show_use(path, arguments);
        }
    }
    if let Some(path) = &arguments.json.json {
        write_json(path, &results::Determination::of(&design, name_of(written).as_deref()), arguments.overwriting)?;
    }
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
