//! `excavator view`

use std::path::Path;

use excavator_bags::MappedUnit;
use excavator_bags::map::{Origin, read_recording_or_mapped};
use excavator_model::recording::{Recording, is_measured};
use excavator_report::{Viewed, ViewedSignal, recordings_page};
use excavator_study::recording_part::Part;

use super::info::display_unit;
use crate::cli::ViewArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::terminal::{print, remark};

/// Share of its travel by which a piston has left the place where it stood.
const MOVED: f64 = 0.02;

pub fn run(arguments: &ViewArguments) -> Result<(), VerbError> {
    let inputs = Inputs::recordings(&arguments.bags, arguments.map.as_deref());
    files::check(&[("--report", Some(&arguments.report))], &inputs, arguments.overwriting)?;
    let origin = Origin { map: arguments.map.as_deref(), namespace: arguments.namespace.as_deref() };
    let mut mapped = Vec::new();
    let mut recordings = Vec::new();
    for bag in &arguments.bags {
        let (recording, units) = read(bag, origin)?;
        recordings.push(recording);
        mapped.extend(units);
    }
    let signals = signals(&recordings, &mapped, &arguments.signal)?;
    let zero = |recording: &Recording| {
        let first = recording.time.first().copied().unwrap_or(0.0);
        if arguments.from_motion { first_motion(recording).unwrap_or(first) } else { first }
    };
    let viewed: Vec<Viewed<'_>> =
        recordings.iter().map(|recording| Viewed { recording, zero: zero(recording) }).collect();
    files::write(&arguments.report, &recordings_page(&viewed, &signals), arguments.overwriting)?;
    let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
    print(&format!("{} of {}.", count(signals.len(), "signal"), count(recordings.len(), "recording")));
    if let Some(bag) = arguments.bags.first() {
        let (whole, _) = Part::split(bag)?;
        let step = NextStep::new("see what these signals can identify", "info").word(whole.display().to_string());
        let step = arguments.map.iter().fold(step, |step, map| step.path("--map", map));
        print_next(&arguments.namespace.iter().fold(step, |step, name| step.word("--namespace").word(name.as_str())));
    }
    Ok(())
}

/// A recording as it is, and the units that its map gives.
fn read(path: &Path, origin: Origin<'_>) -> Result<(Recording, Vec<MappedUnit>), VerbError> {
    let (whole, part) = Part::split(path)?;
    let (mut recording, report) = read_recording_or_mapped(&whole, origin)?;
    report.problems().iter().for_each(|problem| remark(&format!("{}: {problem}", path.display())));
    if let Some(part) = part {
        recording = part.of(&recording, path)?;
    }
    Ok((recording, report.mapped))
}

/// The wanted signals, or all that some recording measures.
fn signals(recordings: &[Recording], mapped: &[MappedUnit], wanted: &[String]) -> Result<Vec<ViewedSignal>, VerbError> {
    let mut measured: Vec<String> = Vec::new();
    for (name, values) in recordings.iter().flat_map(Recording::signals) {
        if is_measured(values) && !measured.contains(&name) {
            measured.push(name);
        }
    }
    if let Some(unknown) = wanted.iter().find(|name| !measured.contains(name)) {
        return Err(VerbError::NoSignal { name: unknown.clone(), measured: measured.join(", ") });
    }
    let names = if wanted.is_empty() { measured } else { wanted.to_vec() };
    let with_unit = |name: String| {
        let (factor, symbol) = display_unit(&name, mapped);
        ViewedSignal { name, factor, symbol: on_pages(symbol) }
    };
    Ok(names.into_iter().map(with_unit).collect())
}

/// A unit as pages write it: terminals keep to plain letters.
fn on_pages(symbol: &'static str) -> &'static str {
    match symbol {
        "mm2" => "mm²",
        "m2" => "m²",
        "m3/s" => "m³/s",
        "deg" => "°",
        "degC" => "°C",
        other => other,
    }
}

/// Time (s) at which a piston first leaves the place where it stood.
fn first_motion(recording: &Recording) -> Option<f64> {
    let starts = recording.cylinders.iter().filter_map(|cylinder| {
        let position =
            [&cylinder.displacement, &cylinder.joint_angle].into_iter().find(|signal| is_measured(signal))?;
        let known = || position.iter().copied().filter(|value| value.is_finite());
        let (least, most) =
            known().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| (a.min(value), b.max(value)));
        let first = known().next()?;
        let left = position.iter().position(|value| (value - first).abs() > MOVED * (most - least))?;
        recording.time.get(left).copied()
    });
    starts.reduce(f64::min)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn motion_begins_where_a_piston_leaves_its_place() {
        let time: Vec<f64> = (0..1000).map(|sample| f64::from(sample) * 0.01).collect();
        let mut recording = Recording::unmeasured("run", time, &["boom", "arm"]);
        assert_eq!(first_motion(&recording), None);
        recording.cylinders[0].displacement.fill(0.1);
        assert_eq!(first_motion(&recording), None);
        for (sample, value) in recording.cylinders[1].joint_angle.iter_mut().enumerate() {
            *value = if sample < 300 { 1.0 + 1e-4 * (sample % 2) as f64 } else { 1.0 + 0.01 * (sample - 300) as f64 };
        }
        let found = first_motion(&recording).unwrap();
        assert!((3.0..3.2).contains(&found), "{found}");
    }
}
