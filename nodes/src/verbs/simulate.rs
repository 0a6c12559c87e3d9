//! `excavator simulate`

use std::path::Path;

use excavator_bags::{Topics, WriteOptions, write_recording};
use excavator_model::Model;
use excavator_model::equations::{Inputs, System};
use excavator_model::machine::Supply;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, Profile, RunError, Tolerances, rest_state, simulate, simulate_from};
use serde::Deserialize;

use super::print;
use crate::cli::SimulateArguments;
use crate::error::VerbError;
use crate::sources;

/// A profile file: what each cylinder is asked to do.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProfileFile {
    /// Samples per second of the bag.
    #[serde(default = "usual_rate")]
    rate: f64,
    /// Piston displacement of each cylinder at the start, m from mid-stroke; zero where not given.
    #[serde(default)]
    start: std::collections::BTreeMap<String, f64>,
    /// One profile per cylinder that moves.
    profiles: Vec<Profile>,
}

/// 1 kHz, as the live simulator publishes.
fn usual_rate() -> f64 {
    1000.0
}

pub fn run(arguments: &SimulateArguments) -> Result<(), VerbError> {
    let model = sources::model(&arguments.model)?;
    let simulated = if arguments.input.extension().is_some_and(|extension| extension == "toml") {
        with_profile(&model, &arguments.input)?
    } else {
        simulate(&model, &sources::recording(&arguments.input, &arguments.mapping, &model)?)?
    };
    write_recording(&arguments.output, &simulated, &Topics::default(), &WriteOptions::default())?;
    print(&format!(
        "{}: {} samples, {:.1} s of {}",
        arguments.output.display(),
        simulated.len(),
        simulated.duration(),
        model.machine.name
    ));
    Ok(())
}

fn with_profile(model: &Model, path: &Path) -> Result<Recording, VerbError> {
    let text = std::fs::read_to_string(path).map_err(|source| VerbError::Read { path: path.to_path_buf(), source })?;
    let syntax = |reason: String| VerbError::ProfileSyntax { path: path.to_path_buf(), reason };
    let file: ProfileFile = toml::from_str(&text).map_err(|error| syntax(error.message().replace('\n', " ")))?;
    if !(1.0..=100_000.0).contains(&file.rate) {
        return Err(syntax(format!("rate = {} must be between 1 and 100000 samples per second", file.rate)));
    }
    let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    for name in file.profiles.iter().map(|profile| &profile.cylinder).chain(file.start.keys()) {
        if !names.contains(&name.as_str()) {
            return Err(VerbError::ProfileCylinder {
                machine: model.machine.name.clone(),
                cylinder: name.clone(),
                known: names.join(", "),
            });
        }
    }
    file.profiles.iter().try_for_each(Profile::check)?;
    let duration = file.profiles.iter().map(Profile::duration).fold(0.0, f64::max);
    let samples = (duration * file.rate).round() as usize + 1;
    let time: Vec<f64> = (0..samples).map(|index| index as f64 / file.rate).collect();
    let mut recording = Recording::unmeasured(&path.display().to_string(), time, &names);
    if let Supply::PumpLine(line) = model.machine.supply {
        recording.tank_pressure.fill(line.tank_pressure);
        recording.pump_flow.fill(line.flow);
    }
    for signals in &mut recording.cylinders {
        let own = file.profiles.iter().find(|profile| profile.cylinder == signals.name);
        for (index, &t) in recording.time.iter().enumerate() {
            let area = own.map_or(0.0, |profile| profile.area(t));
            signals.orifice_area[index] = area;
            signals.orifice_command[index] = area;
            signals.rod_force[index] = 0.0;
        }
    }
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
