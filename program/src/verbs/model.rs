//! `excavator model`

use std::f64::consts::TAU;

use excavator_model::check::{Oddity, Oscillation, Trial, oddities, oscillations, trial};
use excavator_model::display::PressureUnit;
use excavator_model::document::{reference, schema};
use excavator_model::machine::{Cylinder, Drive, Supply};
use excavator_model::{Model, addition_name, site_name, urdf};
use excavator_study::numbers::number;
use serde_json::{Value, json};

use super::{new_model, position_test, valve_test};
use crate::cli::{ModelCheckArguments, ModelChoice, ModelVerb};
use crate::error::VerbError;
use crate::files::{self, Inputs, finite, write_json};
use crate::sources;
use crate::terminal::{print, print_text};

pub fn run(verb: &ModelVerb) -> Result<(), VerbError> {
    match verb {
        ModelVerb::New(arguments) => new_model::run(arguments),
        ModelVerb::Check(arguments) => check(arguments),
        ModelVerb::Valve(arguments) => valve_test::run(arguments),
        ModelVerb::Position(arguments) => position_test::run(arguments),
        ModelVerb::Urdf(choice) => {
            print_text(urdf(&sources::model(choice)?.machine).trim_end());
            Ok(())
        }
        ModelVerb::Schema(own) => {
            print_text(&serde_json::to_string_pretty(&schema(&sources::catalogue(own)?))?);
            Ok(())
        }
        ModelVerb::Reference(own) => {
            print_text(reference(&sources::catalogue(own)?).trim_end());
            Ok(())
        }
    }
}

fn check(arguments: &ModelCheckArguments) -> Result<(), VerbError> {
    let choice = ModelChoice { model: arguments.file.clone(), own: arguments.own.clone() };
    let inputs = Inputs::default().and_all(choice.files());
    files::check(&[arguments.result.output()], &inputs, arguments.result.overwriting)?;
    let model = sources::model(&choice)?;
    let trials: Vec<Option<Trial>> =
        (0..model.machine.cylinders.len()).map(|cylinder| trial(&model, cylinder).ok().flatten()).collect();
    let (oscillations, odd) = (oscillations(&model), oddities(&model));
    if arguments.result.is_shown() {
        let name = &model.machine.name;
        print(&match odd.len() {
            0 => format!("No number is suspicious in {name}."),
            1 => format!("One number is suspicious in {name}."),
            more => format!("{more} numbers are suspicious in {name}."),
        });
        describe(&model);
        for (cylinder, trial) in model.machine.cylinders.iter().zip(&trials) {
            print(&of_trial(cylinder, trial.as_ref()));
        }
        if let Some(text) = of_oscillations(&oscillations) {
            print(&text);
        }
        unused_formulas(&model)
            .iter()
            .for_each(|name| print(&format!("note: no [[effects]] entry uses formula {name}")));
        odd.iter().for_each(|oddity| print(&format!("suspicious: {oddity}")));
    }
    write_json(&to_json(&model, &trials, &oscillations, &odd), &arguments.result)?;
    match odd.len() {
        0 => Ok(()),
        oddities => Err(VerbError::OddModel { name: arguments.file.clone(), oddities }),
    }
}

fn describe(model: &Model) {
    let machine = &model.machine;
    print(&format!("{}: {}", machine.name, machine.description));
    let supply = match machine.supply {
        Supply::PumpLine(line) => format!("pump line, {} l/min", number(6e4 * line.flow)),
        Supply::PressureSource(source) => format!(
            "supply at {} {}",
            number(PressureUnit::shown().factor() * source.pressure),
            PressureUnit::shown().symbol()
        ),
        Supply::None => "no oil".to_string(),
    };
    let unknown = model.unknown_parameters().len();
    let parameters = model.parameters().count();
    print(&format!(
        "{} effects with {parameters} parameters, {unknown} of them to identify; {supply}",
        model.effects.len()
    ));
    let own: Vec<String> = model
        .effects
        .iter()
        .filter(|effect| effect.physics.formula().is_some())
        .map(|effect| addition_name(effect.name(), site_name(machine, effect.site)))
        .collect();
    if !own.is_empty() {
        print(&format!("formulas: {}", own.join(", ")));
    }
    for entry in &model.history {
        print(&format!("history: {} {}", entry.when, entry.what));
    }
}

/// Formulas that the model contains but does not use.
fn unused_formulas(model: &Model) -> Vec<String> {
    let is_used = |name: &str| model.effects.iter().any(|effect| effect.name() == name);
    let own = model.catalogue.iter().filter(|effect| effect.formula().is_some());
    own.map(|effect| effect.card().name.to_string()).filter(|name| !is_used(name)).collect()
}

fn of_trial(cylinder: &Cylinder, trial: Option<&Trial>) -> String {
    let what = match (cylinder.is_motor(), &cylinder.chambers) {
        (true, Some(motor)) => format!("motor of {} cm3 a turn", number(1e6 * TAU * motor.cap_area)),
        _ => format!("stroke {} mm", number(1e3 * cylinder.stroke)),
    };
    let what = format!("{}: {what}", cylinder.name);
    let Some(Trial { speeds: [retracting, extending], pressures: [least, most], duration }) = trial else {
        return what;
    };
    let drive = match cylinder.chambers.map(|chambers| chambers.drive) {
        Some(Drive::Pump { .. }) => "its pump at full flow",
        _ => "its valve fully open",
    };
    let speeds = if cylinder.is_motor() {
        let turns = |speed: f64| number(60.0 * speed / TAU);
        format!("its shaft turns at {} rpm, and at {} rpm the other way", turns(*extending), turns(*retracting))
    } else {
        format!("it extends at {} mm/s and retracts at {} mm/s", number(1e3 * extending), number(1e3 * retracting))
    };
    let unit = PressureUnit::shown();
    let [least, most] = [least, most].map(|pressure| unit.factor() * pressure);
    format!("{what}; with {drive} for {duration} s {speeds}, at {least:.1} to {most:.1} {}", unit.symbol())
}

fn of_oscillations(oscillations: &[Oscillation]) -> Option<String> {
    let words: Vec<String> = oscillations
        .iter()
        .map(|one| format!("{} Hz (damping ratio {})", number(one.frequency), number(one.damping)))
        .collect();
    (!words.is_empty()).then(|| format!("oscillates at mid-stroke with closed valves: {}", words.join(", ")))
}

fn to_json(model: &Model, trials: &[Option<Trial>], oscillations: &[Oscillation], odd: &[Oddity]) -> Value {
    let cylinders: Vec<Value> = model
        .machine
        .cylinders
        .iter()
        .zip(trials)
        .map(|(cylinder, trial)| {
            let mut value = json!({ "name": cylinder.name, "stroke_m": finite(cylinder.stroke) });
            if let Some(Trial { speeds, pressures, duration }) = trial {
                value["valve_fully_open"] = json!({
                    "duration_s": duration, "retracting_m_s": speeds[0], "extending_m_s": speeds[1], "pressures_pa": pressures,
                });
            }
            value
        })
        .collect();
    let oscillations: Vec<Value> =
        oscillations.iter().map(|one| json!({ "frequency_hz": one.frequency, "damping_ratio": one.damping })).collect();
    json!({
        "machine": model.machine.name, "cylinders": cylinders, "oscillations": oscillations,
        "unused_formulas": unused_formulas(model), "oddities": odd.iter().map(ToString::to_string).collect::<Vec<_>>(),
    })
}
