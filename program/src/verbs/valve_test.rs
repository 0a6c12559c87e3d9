//! `excavator model valve`

use std::path::Path;

use excavator_bags::map::{Dimension, Unit};
use excavator_identification::characterisation::{Estimate, StaticEdge};
use excavator_model::Model;
use excavator_model::document::to_text;
use excavator_model::machine::Drive;
use excavator_study::json_text;
use excavator_study::numbers::number as in_digits;
use excavator_study::valve_test::{ValveTestTable, ValveTested};

use super::new_model::number;
use crate::cli::{ModelChoice, ValveTestArguments};
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::print;

pub fn run(arguments: &ValveTestArguments) -> Result<(), VerbError> {
    let choice = arguments.model.clone().map(|model| ModelChoice { model, own: arguments.own.clone() });
    let inputs = Inputs::recordings([&arguments.table], None).and_all(choice.iter().flat_map(ModelChoice::files));
    let written = [("-o", arguments.output.as_deref()), arguments.result.output()];
    files::check(&written, &inputs, arguments.result.overwriting)?;
    let target = match &choice {
        None => None,
        Some(choice) => Some(target(sources::model(choice)?, arguments)?),
    };
    let tested = table(arguments)?.read(target.as_ref().map(|target| target.takes))?;
    if arguments.result.is_shown() {
        lines(&tested, &arguments.table).iter().for_each(|line| print(line));
    }
    if let Some(json) = &arguments.result.json {
        files::write(json, &json_text(&tested)?, arguments.result.overwriting)?;
    }
    let (Some(Target { mut model, place, .. }), Some(output)) = (target, &arguments.output) else { return Ok(()) };
    tested.put_into(&mut model, place, &arguments.table)?;
    files::write(output, &to_text(&model)?, arguments.result.overwriting)?;
    print(&format!("written: {}", output.display()));
    let step = NextStep::new("try the machine", "model").word("check").word(output.display().to_string());
    print_next(&arguments.own.catalogue.iter().fold(step, |step, own| step.path("--catalogue", own)));
    Ok(())
}

/// The valve that the result goes into.
struct Target {
    model: Model,
    /// Its cylinder.
    place: usize,
    /// Dimension of its input.
    takes: Dimension,
}

fn target(model: Model, arguments: &ValveTestArguments) -> Result<Target, VerbError> {
    let place = match &arguments.cylinder {
        None => 0,
        Some(name) => model
            .machine
            .cylinder_index(name)
            .ok_or_else(|| VerbError::ValveTest(format!("{} has no cylinder {name}", model.machine.name)))?,
    };
    let cylinder = &model.machine.cylinders[place];
    match cylinder.chambers.map(|chambers| chambers.drive) {
        Some(Drive::Valve { unit, .. }) => Ok(Target { place, takes: Dimension::of_command(unit), model }),
        _ => Err(VerbError::ValveTest(format!("{} of {} has no valve", cylinder.name, model.machine.name))),
    }
}

fn table(arguments: &ValveTestArguments) -> Result<ValveTestTable, VerbError> {
    let unit = |option: &str, name: &Option<String>| match name.as_deref() {
        None => Ok(None),
        Some(name) => Unit::named(name).map(Some).ok_or_else(|| {
            VerbError::ValveTest(format!("{option} \"{name}\" is not a unit; units are {}", Unit::names()))
        }),
    };
    let null = arguments.null.as_deref().map(|text| number::command("--null", text)).transpose()?;
    Ok(ValveTestTable {
        table: arguments.table.clone(),
        input: arguments.input.clone(),
        flow: arguments.flow.clone(),
        input_unit: unit("--input-unit", &arguments.input_unit)?,
        flow_unit: unit("--flow-unit", &arguments.flow_unit)?,
        pressure_drop: number::of("--drop", &arguments.drop, Dimension::Pressure, "35 bar")?,
        null: null.map(|(value, _)| value),
    })
}

/// The result in the units of the table.
fn lines(tested: &ValveTested, table: &Path) -> Vec<String> {
    let (input, flow) = (&*tested.input_unit, &*tested.flow_unit);
    let with = |one: Estimate, unit: &str| {
        let margin = if one.error > 0.0 { format!(" ± {}", in_digits(1.96 * one.error)) } else { String::new() };
        format!("{}{margin} {unit}", in_digits(one.value))
    };
    let valve = &tested.in_table_units;
    let of_edge = |side: &str, edge: &StaticEdge| {
        let play = edge.play.map_or("the test runs in one direction only, so play is unknown".to_string(), |play| {
            format!("play {}", with(play, input))
        });
        let (gain, zone) = (with(edge.gain, &format!("{flow}/{input}")), edge.dead_zone);
        let zone = if zone.value < 0.0 {
            let underlap = Estimate { value: -zone.value, ..zone };
            format!("underlap {}", with(underlap, input))
        } else {
            format!("dead zone {}", with(zone, input))
        };
        format!("{side}: flow gain {gain}, {zone}, {play} ({} readings)", edge.readings)
    };
    let mut lines = vec![format!(
        "{} readings of {} at a drop of {} bar: null at {}.",
        tested.readings,
        table.display(),
        in_digits(tested.pressure_drop / 1e5),
        with(valve.null, input)
    )];
    let named = ["above the null", "below the null"].into_iter().zip(&valve.sides);
    lines.extend(named.map(|(side, edge)| match edge {
        Some(edge) => of_edge(side, edge),
        None => format!("{side}: no readings on a straight line"),
    }));
    lines
}
