//! How each cost grows: with the length of a recording, with joints, with candidates.

use std::path::Path;

use excavator_blind::cases::{Case, Sort, Wish};
use excavator_blind::instruments::Instruments;
use excavator_blind::scoring::make;
use excavator_identification::diagnosis::{DiagnosisSettings, diagnose};
use excavator_model::document::{built_in, parse_catalogue};
use excavator_model::effects::Catalogue;
use excavator_model::equations::System;
use excavator_model::simulation::{InputSignals, Integrator, Sensitivity, Tolerances};

use crate::clock::best_of;
use crate::common;
use crate::figures::{Group, Run};
use crate::verbs::{Program, long_recording};

/// Lengths of recordings at 1 kHz, s.
const LENGTHS: [f64; 4] = [10.0, 60.0, 600.0, 3600.0];
/// Machines of one to four joints.
const JOINTS: [(&str, usize); 4] = [("zx30u-arm", 1), ("zx30u", 2), ("zx30u-bucket", 3), ("zx30u-excavator", 4)];
/// Effects in the catalogue.
const CANDIDATES: [usize; 4] = [8, 25, 100, 200];

/// One group for each verb, by the length of the recording.
///
/// # Errors
/// In words, where a recording cannot be made or the program fails.
pub fn lengths(program: &Program<'_>) -> Result<Vec<Group>, String> {
    let mut verbs: Vec<Group> = Vec::new();
    for seconds in LENGTHS {
        let all = long_recording(program, seconds, 1000.0)?;
        clear(program.folder)?;
        for (place, run) in all.runs.into_iter().enumerate() {
            if verbs.len() <= place {
                verbs.push(Group {
                    name: format!("{} at 1 kHz, by length", run.name),
                    what: "The same arm for longer.".into(),
                    result: all.result.clone(),
                    runs: Vec::new(),
                });
            }
            verbs[place].runs.push(Run { name: crate::verbs::length_of(seconds), ..run });
        }
    }
    Ok(verbs)
}

/// Recordings of an hour are large: each length is deleted before the next.
fn clear(folder: &Path) -> Result<(), String> {
    std::fs::remove_dir_all(folder).and_then(|()| std::fs::create_dir(folder)).map_err(|error| error.to_string())
}

/// One simulation with sensitivities to everything that is identified, by the number of joints.
///
/// # Errors
/// In words, where a machine cannot be simulated.
pub fn joints() -> Result<Group, String> {
    const DURATION: f64 = 38.0;
    let mut runs = Vec::new();
    for (name, joints) in JOINTS {
        let model = built_in(name).map_err(|error| error.to_string())?;
        let area = |number: usize, time: f64| 4e-5 * (std::f64::consts::PI * time + number as f64).sin();
        let recording = common::driven(&model, DURATION, 1e-3, area, |_| 0.0);
        let signals = InputSignals::from_recording(&model, &recording).map_err(|error| error.to_string())?;
        let system = System::new(&model);
        let wanted = model.unknown_parameters();
        let columns = wanted.len() + system.layout().len;
        let work = || -> Result<(), String> {
            let mut integrator = Integrator::new(&system, &model.parameter_values(), &wanted, Tolerances::default());
            let mut state = common::at_rest(&system);
            let mut sensitivity = Sensitivity::at_start(&system, &wanted);
            for index in 0..signals.len() - 1 {
                let advanced = integrator.advance(&signals, index, &mut state, Some(&mut sensitivity));
                advanced.map_err(|error| error.to_string())?;
            }
            Ok(())
        };
        let (seconds, done) = best_of(3, work);
        done?;
        runs.push(Run::timed(
            format!("{joints} joint{} ({name})", if joints == 1 { "" } else { "s" }),
            seconds,
            format!(
                "{columns} sensitivities, {} states, {:.0} times real time",
                system.layout().len,
                DURATION / seconds
            ),
        ));
    }
    Ok(Group {
        name: "Simulating 38 s with all sensitivities, by joints".into(),
        what: "Every joint driven by its own sine, 1 kHz.".into(),
        result: "size".into(),
        runs,
    })
}

/// A diagnosis of a machine with one effect, with more and more candidates.
///
/// # Errors
/// In words, where the machine cannot be recorded or diagnosed.
pub fn candidates() -> Result<Group, String> {
    let mut case = Case::draw(91, 0, &Wish { sort: Some(Sort::Single), ..Wish::default() });
    let evidence = make(&mut case, &Instruments::default()).map_err(|error| error.to_string())?;
    let mut runs = Vec::new();
    for wanted in CANDIDATES {
        let mut model = built_in("zx30u-arm").map_err(|error| error.to_string())?;
        let given: Vec<String> = model.effects.iter().map(|effect| effect.name().to_string()).collect();
        model.catalogue = catalogue_of(&given, &case.secret(), wanted)?;
        let settings = DiagnosisSettings::default();
        let (seconds, found) = best_of(1, || {
            diagnose(&model, &[&evidence.identification], &[&evidence.validation], &settings, &|_, _| ())
        });
        let found = found.map_err(|error| error.to_string())?;
        let first = found.candidates().first().map_or("nothing", |candidate| candidate.name()).to_string();
        runs.push(Run::timed(format!("{wanted} effects beside the model's own"), seconds, format!("first: {first}")));
    }
    Ok(Group {
        name: "diagnose, by effects in the catalogue".into(),
        what: format!(
            "38 s + 20 s at 500 Hz of a machine with {}. Effects beyond the built-in ones are formulas: friction at a place of the stroke.",
            case.secret()
        ),
        result: "found".into(),
        runs,
    })
}

/// What the model has, what is hidden, and others up to a number.
fn catalogue_of(given: &[String], hidden: &str, wanted: usize) -> Result<Catalogue, String> {
    let all = Catalogue::built_in();
    let is_first = |name: &str| given.iter().any(|other| other == name) || name == hidden;
    let mut effects: Vec<_> = all.iter().filter(|effect| is_first(&effect.card().name)).cloned().collect();
    let others = all.iter().filter(|effect| !is_first(&effect.card().name)).cloned();
    effects.extend(others.take(wanted.saturating_sub(1)));
    let missing = (given.len() + wanted).saturating_sub(effects.len());
    let catalogue = Catalogue::of(effects);
    let formulas: String = (0..missing)
        .map(|number| {
            let place = -0.4 + 0.8 * number as f64 / missing as f64;
            format!(
                "[[formula]]\nname = \"friction_at_{number}\"\nacts_on = \"piston_force\"\n\
                 formula = \"-F*sign(v)*exp(-((s/stroke - {place:.4})/0.02)^2)\"\n\
                 parameters.F = {{ unit = \"N\", minimum = 0.0, maximum = 1e5, start = [100.0], meaning = \"friction there\" }}\n"
            )
        })
        .collect();
    parse_catalogue("places.toml", &formulas, &catalogue).map_err(|error| error.to_string())
}
