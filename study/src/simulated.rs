//! Simulates commands from rest.

use std::collections::BTreeMap;
use std::path::Path;

use excavator_model::Model;
use excavator_model::equations::{Inputs, System, USUAL_OIL_TEMPERATURE};
use excavator_model::machine::Supply;
use excavator_model::recording::{Recording, is_measured};
use excavator_model::simulation::{InputSignals, Profile, RunError, Tolerances, rest_state, simulate_from};

use crate::WorkError;
use crate::profile_file::ProfileFile;

/// Simulates a profile. `source` is its name in messages and in the result.
///
/// ```
/// use std::path::Path;
///
/// use excavator_model::document::built_in;
/// use excavator_study::profile_file::ProfileFile;
/// use excavator_study::simulated::simulate_profile;
///
/// let text = r#"
///     rate = 100.0
///     [[profiles]]
///     cylinder = "arm"
///     segments = [{ kind = "sine", duration = 1.0, amplitude = 3e-5, frequency = 1.0 }]
/// "#;
/// let (model, path) = (built_in("zx30u-arm")?, Path::new("swing.toml"));
/// let profile = ProfileFile::of_text(path, text, &model.machine)?;
/// let recording = simulate_profile(&model, &profile, path)?;
/// assert_eq!(recording.len(), 101);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`WorkError`] if the machine cannot start there, or the simulation fails.
pub fn simulate_profile(model: &Model, file: &ProfileFile, source: &Path) -> Result<Recording, WorkError> {
    let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    let samples = (file.duration() * file.rate).round() as usize + 1;
    let time: Vec<f64> = (0..samples).map(|index| index as f64 / file.rate).collect();
    let mut recording = Recording::unmeasured(&source.display().to_string(), time, &names);
    Profile::command(&file.profiles, &mut recording);
    simulate_commands(model, recording, &file.start, source)
}

/// Simulates commands from rest at `start` (displacement of each cylinder, m from mid-stroke; zero if not given). If
/// the commands do not include flow and tank pressure of a pump line, those of the machine are used.
///
/// # Errors
/// As [`simulate_profile`].
pub fn simulate_commands(
    model: &Model,
    mut commands: Recording,
    start: &BTreeMap<String, f64>,
    source: &Path,
) -> Result<Recording, WorkError> {
    if let Supply::PumpLine(line) = model.machine.supply {
        for (signal, value) in [(&mut commands.tank_pressure, line.tank_pressure), (&mut commands.pump_flow, line.flow)]
        {
            if !is_measured(signal) {
                signal.fill(value);
            }
        }
    }
    if model.reads_temperature() && !is_measured(&commands.oil_temperature) {
        commands.oil_temperature.fill(USUAL_OIL_TEMPERATURE);
    }
    let cylinders = &model.machine.cylinders;
    let signals = InputSignals::from_recording(model, &commands)?;
    if signals.is_empty() {
        return Ok(commands);
    }
    let system = System::new(model);
    let mut inputs = Inputs::zero(cylinders.len());
    signals.between(0, 0.0, &mut inputs);
    let displacements: Vec<f64> =
        cylinders.iter().map(|cylinder| start.get(&cylinder.name).copied().unwrap_or(0.0)).collect();
    let state = rest_state(&system, &displacements, &inputs);
    if let Some(number) = (0..cylinders.len()).find(|&number| !state[system.layout().joint(number)].is_finite()) {
        let reason = format!("{} cannot start at {} m", cylinders[number].name, displacements[number]);
        return Err(WorkError::ProfileSyntax { path: source.to_path_buf(), fault: reason.into() });
    }
    Ok(simulate_from(model, &commands, &signals, state, Tolerances::default()).map_err(RunError::Simulation)?)
}
