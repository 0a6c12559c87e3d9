//! Models and recordings by what a person calls them.

use std::path::{Path, PathBuf};

use excavator_bags::ReadReport;
use excavator_bags::map::read_recording_or_mapped;
use excavator_identification::checks;
use excavator_identification::selection::Chosen;
use excavator_model::Model;
use excavator_model::document::{built_in, parse, parse_catalogue};
use excavator_model::effects::Catalogue;
use excavator_model::formula::Condition;
use excavator_model::machine::Supply;
use excavator_model::recording::Recording;
use excavator_model::simulation::input_holes;
#[cfg(feature = "live")]
use excavator_ros::{Parameter, Value};
use rosbag2::{ReadLimits, read_regular_text};

use crate::cli::{self, Extent, Mapping};
use crate::error::VerbError;
use crate::long_recording::recording_or_stretches;
use crate::recording_part::Part;
use crate::terminal::remark;

/// A model by its built-in name or file, with the effects of its user.
pub fn model(choice: &cli::ModelChoice) -> Result<Model, VerbError> {
    model_with(&choice.model, &catalogue(&choice.own)?)
}

/// A second model, with the catalogues of the first.
pub fn another_model(name: &str, first: &cli::ModelChoice) -> Result<Model, VerbError> {
    model_with(name, &catalogue(&first.own)?)
}

/// The parameter by which a node gets its model, where it does not take the one that is published.
#[cfg(feature = "live")]
pub fn model_parameter() -> Parameter {
    let meaning = "built-in model or model file (.toml); empty: the model on arm/model";
    Parameter::new("model", Value::String(String::new()), meaning).read_only()
}

/// The same with the effects of the program and of its own file.
#[cfg(feature = "live")]
pub fn model_named(name: &str) -> Result<Model, VerbError> {
    model_with(name, &Catalogue::built_in())
}

fn model_with(name: &str, catalogue: &Catalogue) -> Result<Model, VerbError> {
    let path = Path::new(name);
    if !path.exists() && !name.ends_with(".toml") {
        return Ok(Model { catalogue: catalogue.clone(), ..built_in(name)? });
    }
    let text = read_regular_text(path, ReadLimits::DEFAULT.document)?;
    Ok(parse(name, &text, catalogue)?)
}

/// The effects of the program and those of these catalogue files; of a folder, every TOML file in it, by name.
pub fn catalogue(own: &cli::OwnEffects) -> Result<Catalogue, VerbError> {
    let mut catalogue = Catalogue::built_in();
    for path in &own.catalogue {
        let files = if path.is_dir() { catalogue_files(path)? } else { vec![path.clone()] };
        for file in files {
            let text = read_regular_text(&file, ReadLimits::DEFAULT.document)?;
            catalogue = parse_catalogue(&file.display().to_string(), &text, &catalogue)?;
        }
    }
    Ok(catalogue)
}

fn catalogue_files(folder: &Path) -> Result<Vec<PathBuf>, VerbError> {
    let unusable = |reason: String| VerbError::Catalogue { path: folder.to_path_buf(), reason };
    let entries = std::fs::read_dir(folder).map_err(|error| unusable(error.to_string()))?;
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    if files.is_empty() {
        return Err(unusable("the folder has no catalogue files (.toml)".to_string()));
    }
    Ok(files)
}

/// A recording, with what was wrong in its data told on standard error, checked against the model. Bags of other people
/// and tables are read through `map`, or the map that lies beside them. `BAG@20..40` is the part from 20 s to 40 s.
pub fn recording(path: &Path, map: &Mapping, model: &Model) -> Result<Recording, VerbError> {
    let (whole, part) = Part::split(path)?;
    let (mut recording, report) = read_recording_or_mapped(&whole, map.origin())?;
    if let Some(part) = part {
        recording = part.of(&recording, path)?;
    }
    checked(path, recording, &report, map, model)
}

/// As [`recording`]; of a long one the stretches most informative about the parameters of `model`, unless all of it is wanted. What was
/// chosen is told on standard error.
pub fn telling_recording(path: &Path, extent: Extent, map: &Mapping, model: &Model) -> Result<Recording, VerbError> {
    if extent.whole {
        return recording(path, map, model);
    }
    let (recording, report, chosen) = recording_or_stretches(path, map.origin(), model)?;
    if let Some(chosen) = &chosen {
        remark(&format!("{}: {}", path.display(), choice(&recording, chosen)));
    }
    checked(path, recording, &report, map, model)
}

/// Which stretches were chosen, in a sentence.
fn choice(used: &Recording, chosen: &Chosen) -> String {
    let starts: Vec<String> = chosen.starts.iter().map(|start| format!("{start:.0}")).collect();
    format!(
        "{:.0} of {:.0} s are used: the most informative stretches of {:.0} s, from {} s (stretches at random would give intervals {:.1} times \
         as wide); --whole uses all",
        used.recorded_time(),
        chosen.duration,
        chosen.stretch,
        starts.join(", "),
        chosen.gain
    )
}

/// A recording as it is used, and what is told of it.
fn checked(
    path: &Path,
    mut recording: Recording,
    report: &ReadReport,
    map: &Mapping,
    model: &Model,
) -> Result<Recording, VerbError> {
    leave_pump_pressure_out(model, &mut recording, &report.left_out);
    for problem in report.problems() {
        remark(&format!("{}: {problem}", path.display()));
    }
    for overruled in checks::check(model, &recording, &map.accept)? {
        remark(&format!("accepted: {overruled}"));
    }
    let holes = input_holes(model, &recording);
    if holes.count > 0 {
        remark(&format!(
            "{}: an input is missing for up to {:.2} s, {} time(s); these {:.2} s are left out",
            path.display(),
            holes.longest,
            holes.count,
            holes.total
        ));
        recording = recording.at(&holes.known);
    }
    for found in checks::remarks(model, &recording) {
        remark(&format!("{}: {found}", path.display()));
    }
    let kept = map.conditions.iter().map(|text| (text, true));
    for (text, keeps) in kept.chain(report.left_out_where.iter().map(|text| (text, false))) {
        let condition = Condition::read(text)
            .map_err(|error| VerbError::Condition { text: text.clone(), error: Box::new(error) })?;
        let left_out = leave_out(model, &mut recording, &condition, keeps);
        let holds = if keeps { "where not" } else { "where" };
        remark(&format!("{}: {:.0} % of the time is left out, {holds} {text}", path.display(), 100.0 * left_out));
    }
    Ok(recording)
}

/// Takes away what is compared with a model where the condition does not hold, or, unless it `keeps`, where it does; inputs stay. Gives
/// the share of samples of all cylinders that are left out.
fn leave_out(model: &Model, recording: &mut Recording, condition: &Condition, keeps: bool) -> f64 {
    let mut holds = condition.holds(&model.machine, recording);
    holds.iter_mut().flatten().for_each(|holds| *holds = *holds == keeps);
    let samples = recording.len();
    let left_out = holds.iter().flatten().filter(|holds| !**holds).count();
    for (cylinder, holds) in model.machine.cylinders.iter().zip(&holds) {
        let Some(signals) = recording.cylinders.iter_mut().find(|signals| signals.name == cylinder.name) else {
            continue;
        };
        let outputs: Vec<&mut Vec<f64>> = if cylinder.imposed_motion.is_some() {
            vec![&mut signals.rod_force]
        } else {
            vec![
                &mut signals.displacement,
                &mut signals.joint_angle,
                &mut signals.velocity,
                &mut signals.cap_pressure,
                &mut signals.rod_pressure,
            ]
        };
        for output in outputs {
            output.iter_mut().zip(holds).filter(|(_, holds)| !**holds).for_each(|(value, _)| *value = f64::NAN);
        }
    }
    if matches!(model.machine.supply, Supply::PumpLine(_)) {
        for (sample, value) in recording.pump_pressure.iter_mut().enumerate() {
            if holds.iter().any(|holds| !holds[sample]) {
                *value = f64::NAN;
            }
        }
    }
    left_out as f64 / (samples * holds.len()).max(1) as f64
}

/// Takes away the pump pressure between these moments, ns, where it is compared with a model, and no input.
fn leave_pump_pressure_out(model: &Model, recording: &mut Recording, stretches: &[[i64; 2]]) {
    if !matches!(model.machine.supply, Supply::PumpLine(_)) {
        return;
    }
    let start = recording.start_nanoseconds;
    for (time, pressure) in recording.time.iter().zip(&mut recording.pump_pressure) {
        let moment = start.saturating_add((time * 1e9).round() as i64);
        if stretches.iter().any(|[first, last]| (*first..=*last).contains(&moment)) {
            *pressure = f64::NAN;
        }
    }
}

/// Several recordings.
pub fn recordings(paths: &[impl AsRef<Path>], map: &Mapping, model: &Model) -> Result<Vec<Recording>, VerbError> {
    paths.iter().map(|path| recording(path.as_ref(), map, model)).collect()
}

/// Several recordings, of long ones the most informative stretches.
pub fn telling_recordings(
    paths: &[impl AsRef<Path>],
    extent: Extent,
    map: &Mapping,
    model: &Model,
) -> Result<Vec<Recording>, VerbError> {
    paths.iter().map(|path| telling_recording(path.as_ref(), extent, map, model)).collect()
}

/// The recordings that parameters are fitted to and those that judge the fit, with what they have in common told on standard
/// error.
pub fn fitted_and_judging(
    paths: &cli::Recordings,
    model: &Model,
) -> Result<(Vec<Recording>, Vec<Recording>), VerbError> {
    let identification = telling_recordings(&paths.identification, paths.extent, &paths.mapping, model)?;
    let validation = telling_recordings(&paths.validation, paths.extent, &paths.mapping, model)?;
    let (fitted, judging): (Vec<_>, Vec<_>) = (identification.iter().collect(), validation.iter().collect());
    for shared in checks::shared_readings(&fitted, &judging) {
        remark(&shared.to_string());
    }
    Ok((identification, validation))
}
