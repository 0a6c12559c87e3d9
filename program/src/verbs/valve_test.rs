//! `excavator model valve`

use excavator_bags::map::{Dimension, Unit};
use excavator_bags::table::{Table, TableFormat, Values};
use excavator_identification::characterisation::{Estimate, FlowReading, StaticEdge, static_valve};
use excavator_model::document::to_text;
use excavator_model::effects::Site;
use excavator_model::machine::{CommandUnit, Drive};
use excavator_model::{Model, ModelError};
use excavator_study::numbers::number as in_digits;

use super::new_model::number;
use crate::cli::ValveTestArguments;
use crate::error::VerbError;
use crate::files::{self, Inputs};
use crate::next_step::{NextStep, print_next};
use crate::sources;
use crate::terminal::print;

/// Standard errors from zero above which a dead zone or a play counts as real.
const CLEAR: f64 = 3.0;

/// Share of the full input below which neither matters.
const LEAST_SHARE: f64 = 0.003;

pub fn run(arguments: &ValveTestArguments) -> Result<(), VerbError> {
    let inputs = Inputs::recordings([&arguments.table], None).and_all(arguments.model.files());
    files::check(&[("-o", Some(&arguments.output))], &inputs, arguments.overwriting)?;
    let mut model = sources::model(&arguments.model)?;
    let place = match &arguments.cylinder {
        None => 0,
        Some(name) => model
            .machine
            .cylinder_index(name)
            .ok_or_else(|| VerbError::ValveTest(format!("{} has no cylinder {name}", model.machine.name)))?,
    };
    let cylinder = &model.machine.cylinders[place];
    let (name, Some(Drive::Valve { full_command, unit })) =
        (cylinder.name.clone(), cylinder.chambers.map(|chambers| chambers.drive))
    else {
        return Err(VerbError::ValveTest(format!("{} of {} has no valve", cylinder.name, model.machine.name)));
    };
    let readings = readings(arguments, unit)?;
    let edges = static_valve(&readings);
    let [Some(positive), Some(negative)] = edges else {
        return Err(VerbError::ValveTest(format!(
            "{}: of {} readings too few lie between 10 % and 90 % of the largest flow with inputs of both signs",
            arguments.table.display(),
            readings.len()
        )));
    };
    let source = format!("static test {}", arguments.table.display());
    put(&mut model, place, &[positive, negative], full_command, &source)?;
    print(&format!("{} readings of {} tell what the valve of {name} is.", readings.len(), arguments.table.display()));
    for (side, edge) in [("input above zero", positive), ("input below zero", negative)] {
        print(&of_edge(&name, side, &edge, unit));
    }
    files::write(&arguments.output, &to_text(&model)?, arguments.overwriting)?;
    print(&format!("written: {}", arguments.output.display()));
    let output = arguments.output.display().to_string();
    let step = NextStep::new("try the machine", "model").word("check").word(output);
    print_next(&arguments.model.own.catalogue.iter().fold(step, |step, own| step.path("--catalogue", own)));
    Ok(())
}

fn of_edge(name: &str, side: &str, edge: &StaticEdge, unit: CommandUnit) -> String {
    let unit = if unit == CommandUnit::One { "" } else { unit.text() };
    let with_error = |one: Estimate| format!("{} ± {} {unit}", in_digits(one.value), in_digits(1.96 * one.error));
    let play = edge.play.map_or("the test runs in one direction only, so play is unknown".to_string(), |play| {
        format!("play {}", with_error(play).trim_end())
    });
    format!(
        "{name}, {side}: flow gain {} ± {}, dead zone {}, {play} ({} readings)",
        in_digits(edge.gain.value),
        in_digits(1.96 * edge.gain.error),
        with_error(edge.dead_zone).trim_end(),
        edge.readings
    )
}

/// The columns of the test, in SI units and in that of the model's input.
fn readings(arguments: &ValveTestArguments, unit: CommandUnit) -> Result<Vec<FlowReading>, VerbError> {
    let table = Table::read(&arguments.table, &TableFormat::default())?;
    let drop = number::of("--drop", &arguments.drop, Dimension::Pressure, "35 bar")?;
    let column = |name: &str| {
        let found = table.columns.iter().find(|column| column.name.eq_ignore_ascii_case(name)).ok_or_else(|| {
            let names: Vec<&str> = table.columns.iter().map(|column| column.name.as_str()).collect();
            VerbError::ValveTest(format!(
                "{} has no column \"{name}\"; its columns are {}",
                arguments.table.display(),
                names.join(", ")
            ))
        })?;
        let Values::Numbers(values) = &found.values else {
            return Err(VerbError::ValveTest(format!("column \"{name}\" holds dates, not numbers")));
        };
        Ok((values, found.unit.as_deref().and_then(Unit::named)))
    };
    let (input, input_unit) = column(&arguments.input)?;
    let (flow, flow_unit) = column(&arguments.flow)?;
    let flow_unit = flow_unit.filter(|unit| unit.dimension == Dimension::Flow).ok_or_else(|| {
        VerbError::ValveTest(format!(
            "the heading of \"{}\" has no unit of a flow, as in \"Q [l/min]\"",
            arguments.flow
        ))
    })?;
    let wanted = match unit {
        CommandUnit::SquareMetre => Dimension::Area,
        CommandUnit::Volt => Dimension::Voltage,
        CommandUnit::Ampere => Dimension::Current,
        CommandUnit::One | CommandUnit::CubicMetrePerSecond => Dimension::Number,
    };
    if let Some(found) = input_unit.filter(|found| found.dimension != wanted) {
        return Err(VerbError::ValveTest(format!(
            "\"{}\" is in {}, and the model's valve takes {}",
            arguments.input,
            found.name,
            unit.text()
        )));
    }
    let to_model = |value: f64| input_unit.map_or(value, |unit| unit.to_si(value));
    let pairs = input.iter().zip(flow);
    Ok(pairs
        .map(|(&input, &flow)| FlowReading { input: to_model(input), flow: flow_unit.to_si(flow), pressure_drop: drop })
        .collect())
}

/// Puts the results into the model: gains, and a dead zone and a play if they are significant.
fn put(
    model: &mut Model,
    place: usize,
    edges: &[StaticEdge; 2],
    full_command: f64,
    source: &str,
) -> Result<(), ModelError> {
    let site = Site::Cylinder(place);
    let matters = |one: Estimate| one.value > CLEAR * one.error && one.value > LEAST_SHARE * full_command;
    let [positive, negative] = edges;
    set(model, "orifice_flow", site, &[positive.gain.value, negative.gain.value], source)?;
    if edges.iter().any(|edge| matters(edge.dead_zone)) {
        let zones = edges.map(|edge| edge.dead_zone.value.max(0.0));
        set(model, "valve_dead_zone", site, &zones, source)?;
    }
    let plays: Vec<f64> =
        edges.iter().filter_map(|edge| edge.play).filter(|play| matters(*play)).map(|p| p.value).collect();
    if !plays.is_empty() {
        set(model, "valve_hysteresis", site, &[plays.iter().sum::<f64>() / plays.len() as f64], source)?;
    }
    Ok(())
}

/// Sets the first parameters of an effect, which is added if the model does not have it.
fn set(model: &mut Model, effect: &str, site: Site, values: &[f64], source: &str) -> Result<(), ModelError> {
    if !model.effects.iter().any(|one| one.is(effect, site))
        && let Ok(physics) = model.catalogue.find(effect)
    {
        *model = model.with_effect(&physics, site)?;
    }
    let own = model.effects.iter_mut().find(|one| one.is(effect, site));
    for (parameter, value) in own.into_iter().flat_map(|one| &mut one.parameters).zip(values) {
        parameter.value = *value;
        parameter.source = source.to_string();
        parameter.standard_error = None;
        parameter.margin_95 = None;
    }
    Ok(())
}
