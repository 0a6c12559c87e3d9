//! Simulated response of a machine to a fully opened valve.

use crate::Model;
use crate::equations::{Inputs, System, USUAL_OIL_TEMPERATURE};
use crate::machine::Supply;
use crate::recording::Recording;
use crate::simulation::{InputSignals, Profile, RunError, Segment, Tolerances, reachable_rest_state, simulate_from};

/// Response of a cylinder to its valve, stepped fully open at mid-stroke.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// How long the valve was open in each direction, s.
    pub duration: f64,
    /// Largest speed while it retracts and while it extends, m/s.
    pub speeds: [f64; 2],
    /// Least and largest pressure in its chambers, Pa.
    pub pressures: [f64; 2],
}

/// Candidate opening times of the valve, s: the first that keeps the piston within its stroke is used. The longest is long for an
/// excavator, the shortest suits a servo valve on a cylinder of a few millimetres.
const DURATIONS: [f64; 4] = [1.0, 0.2, 0.04, 0.008];

/// Samples per trial.
const SAMPLES: usize = 200;

/// Opens a cylinder's valve fully in both directions, with all others closed. `None` for a cylinder without a valve.
///
/// # Errors
/// [`RunError`] if the machine cannot rest at mid-stroke or the simulation fails.
pub fn trial(model: &Model, cylinder: usize) -> Result<Option<Trial>, RunError> {
    let Some(chambers) = model.machine.cylinders.get(cylinder).and_then(|one| one.chambers) else { return Ok(None) };
    let [retracted, extended] = model.machine.cylinders[cylinder].ends;
    let mut last = Ok(None);
    for duration in DURATIONS {
        let ways = [-1.0, 1.0].map(|way| thrown_open(model, cylinder, way * chambers.full_command(), duration));
        let [retracting, extending] = match ways {
            [Ok(retracting), Ok(extending)] => [retracting, extending],
            [Err(error), _] | [_, Err(error)] => {
                last = Err(error);
                continue;
            }
        };
        let within = |run: &Recording| {
            run.cylinders[cylinder].displacement.iter().all(|place| (retracted..extended).contains(place))
        };
        last = Ok(Some(summary(cylinder, duration, [&retracting, &extending])));
        if within(&retracting) && within(&extending) {
            break;
        }
    }
    last
}

fn summary(cylinder: usize, duration: f64, runs: [&Recording; 2]) -> Trial {
    let fastest = |run: &Recording| {
        let displacement = &run.cylinders[cylinder].displacement;
        let steps = displacement.windows(2).zip(run.time.windows(2));
        steps.map(|(s, t)| ((s[1] - s[0]) / (t[1] - t[0])).abs()).fold(0.0, f64::max)
    };
    let mut pressures = [f64::INFINITY, f64::NEG_INFINITY];
    for run in runs {
        let signals = &run.cylinders[cylinder];
        for &pressure in signals.cap_pressure.iter().chain(&signals.rod_pressure) {
            pressures = [pressures[0].min(pressure), pressures[1].max(pressure)];
        }
    }
    Trial { duration, speeds: runs.map(fastest), pressures }
}

/// Starts at rest at mid-stroke, then holds one valve at `area` m² for `duration` s.
fn thrown_open(model: &Model, cylinder: usize, area: f64, duration: f64) -> Result<Recording, RunError> {
    let names: Vec<&str> = model.machine.cylinders.iter().map(|one| one.name.as_str()).collect();
    let time: Vec<f64> = (0..=SAMPLES).map(|sample| duration * sample as f64 / SAMPLES as f64).collect();
    let mut recording = Recording::unmeasured("trial", time, &names);
    if let Supply::PumpLine(line) = model.machine.supply {
        recording.tank_pressure.fill(line.tank_pressure);
        recording.pump_flow.fill(line.flow);
    }
    recording.oil_temperature.fill(USUAL_OIL_TEMPERATURE);
    // Longer than the trial, so that the last sample is open too.
    let segments = vec![Segment::Hold { duration: 2.0 * duration, area }];
    Profile::command(&[Profile { cylinder: names[cylinder].to_string(), segments }], &mut recording);
    let signals = InputSignals::from_recording(model, &recording)?;
    let system = System::new(model);
    let mut inputs = Inputs::zero(names.len());
    signals.between(0, 0.0, &mut inputs);
    inputs.orifice_area.fill(0.0);
    let rest = reachable_rest_state(&system, &vec![0.0; names.len()], &inputs)?;
    Ok(simulate_from(model, &recording, &signals, rest, Tolerances::default())?)
}
