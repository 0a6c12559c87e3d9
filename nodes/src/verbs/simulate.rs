//! `excavator simulate`

use std::path::Path;

use excavator_bags::{Topics, write_recording};
use excavator_model::Model;
use excavator_model::equations::{Inputs, System};
use excavator_model::machine::Supply;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, Profile, RunError, Tolerances, rest_state, simulate, simulate_from};
use rosbag2::WriteOptions;

use super::{print, print_next};
use crate::cli::SimulateArguments;
use crate::error::VerbError;
use crate::output::NextStep;
use crate::outputs;
use crate::profile_file::ProfileFile;
use crate::{sources, terminal};

pub fn run(arguments: &SimulateArguments) -> Result<(), VerbError> {
    let inputs = outputs::Inputs::recordings([&arguments.input], arguments.mapping.map.as_deref())
        .and_all(arguments.model.files());
    outputs::check_bag(&arguments.output, &inputs, arguments.overwriting)?;
    let model = sources::model(&arguments.model)?;
    let simulated = if arguments.input.extension().is_some_and(|extension| extension == "toml") {
        with_profile(&model, &arguments.input)?
    } else {
        simulate(&model, &sources::recording(&arguments.input, &arguments.mapping, &model)?)?
    };
    let options = WriteOptions { replace: arguments.overwriting.force, ..WriteOptions::default() };
    write_recording(&arguments.output, &simulated, &Topics::default(), &options)?;
    print(&format!(
        "Simulated {:.1} s of {}: {} samples in {}.",
        simulated.duration(),
        model.machine.name,
        simulated.len(),
        arguments.output.display()
    ));
    print_next(&NextStep::new("see what is in it", "info").word(arguments.output.display().to_string()));
    Ok(())
}

fn with_profile(model: &Model, path: &Path) -> Result<Recording, VerbError> {
    let syntax = |reason: String| VerbError::ProfileSyntax { path: path.to_path_buf(), fault: reason.into() };
    let file = ProfileFile::read(path, &model.machine)?;
    for remark in file.remarks(&model.machine) {
        terminal::remark(&format!("{}: {remark}", path.display()));
    }
    let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    let samples = (file.duration() * file.rate).round() as usize + 1;
    let time: Vec<f64> = (0..samples).map(|index| index as f64 / file.rate).collect();
    let mut recording = Recording::unmeasured(&path.display().to_string(), time, &names);
    if let Supply::PumpLine(line) = model.machine.supply {
        recording.tank_pressure.fill(line.tank_pressure);
        recording.pump_flow.fill(line.flow);
    }
    Profile::command(&file.profiles, &mut recording);
    let signals = InputSignals::from_recording(model, &recording)?;
    let system = System::new(model);
    let mut inputs = Inputs::zero(names.len());
    signals.between(0, 0.0, &mut inputs);
    let displacements: Vec<f64> = names.iter().map(|name| file.start.get(*name).copied().unwrap_or(0.0)).collect();
    let state = rest_state(&system, &displacements, &inputs);
    if let Some(cylinder) = (0..names.len()).find(|&c| !state[system.layout().joint(c)].is_finite()) {
        return Err(syntax(format!("{} cannot start at {} m", names[cylinder], displacements[cylinder])));
    }
    simulate_from(model, &recording, &signals, state, Tolerances::default())
        .map_err(|error| RunError::Simulation(error).into())
}
