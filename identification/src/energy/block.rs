//! A stretch of a recording, and the books of its measured state.

use excavator_model::SignalError;
use excavator_model::energy::Accountant;
use excavator_model::equations::{Inputs, KnownCylinder, LawStates, System};
use excavator_model::machine::Supply;
use excavator_model::recording::{Recording, is_measured, noise_level};
use excavator_model::simulation::{InputSignals, undistorted};

use super::smoothing::{Parabola, Parabolas};
use super::{Books, EnergySettings};

/// A stretch without gaps. Its entries are the samples whose number in the recording is a multiple of `stride`, so that
/// overlapping neighbouring blocks have the same entries.
#[derive(Debug, Clone)]
pub(super) struct Block {
    /// The samples, including those that the windows at the ends need.
    pub recording: Recording,
    /// Time of the first sample since the start of the recording, s.
    pub start: f64,
    /// Number of the first sample in the recording.
    pub first_sample: usize,
    /// Samples per entry.
    pub stride: usize,
    /// Part that the block accounts for, s since the start of the recording.
    pub own: (f64, f64),
    /// Whether valve openings may come from the spool sensor alone. The estimate that also uses the command is slightly more
    /// accurate but takes longer than the rest of the analysis.
    pub quick: bool,
    /// Whether the effect of noise is estimated with repeats.
    pub with_noise: bool,
}

impl Block {
    /// Numbers of the samples that have an entry.
    fn entries(&self) -> impl Iterator<Item = usize> + use<> {
        let first = self.first_sample.next_multiple_of(self.stride) - self.first_sample;
        (first..self.recording.len()).step_by(self.stride)
    }
}

/// The measured states and inputs of a block at its entries. Positions and pressures come from parabolas through their samples,
/// narrower ones where a chamber starts to boil. Valves come from the estimate that also drives simulations. Entries are skipped if
/// their windows are cut off by the ends or contain an unmeasured sample.
pub(super) fn measured(system: &System<'_>, block: &Block, settings: &EnergySettings) -> Result<Entries, SignalError> {
    let model = system.model();
    let layout = system.layout();
    let mut recording = undistorted(model, &block.recording);
    if block.quick {
        for cylinder in recording.cylinders.iter_mut().filter(|cylinder| is_measured(&cylinder.orifice_area)) {
            cylinder.orifice_command.fill(f64::NAN);
        }
    }
    let signals = InputSignals::from_recording(model, &recording)?;
    let sources = model
        .machine
        .cylinders
        .iter()
        .map(|cylinder| {
            let signals = recording.cylinder(&cylinder.name)?;
            let displacement = if is_measured(&signals.displacement) {
                signals.displacement.clone()
            } else {
                signals.joint_angle.iter().map(|&joint| cylinder.linkage.displacement(joint)).collect()
            };
            let noise = [&signals.cap_pressure, &signals.rod_pressure].map(|signal| noise_level(signal));
            Ok((displacement, signals, noise))
        })
        .collect::<Result<Vec<_>, SignalError>>()?;
    let mut entries = Entries::new(system, signals);
    let (mut state, mut inputs) = (vec![0.0; layout.len], Inputs::zero(model.machine.cylinders.len()));
    let pump_noise = noise_level(&recording.pump_pressure);
    let (mut motion, mut parabolas) = (Parabola::default(), Parabolas::default());
    for sample in block.entries() {
        if !motion.set(&recording.time, sample, settings.motion_half_width)
            || !parabolas.set(&recording.time, sample, settings.half_width)
        {
            continue;
        }
        entries.signals.between(sample, 0.0, &mut inputs);
        let known = |number: usize| {
            let (displacement, measured, [cap_noise, rod_noise]) = &sources[number];
            let velocity = match measured.velocity[sample] {
                known if known.is_finite() => parabolas.widest(&measured.velocity),
                _ => motion.slope(displacement),
            };
            KnownCylinder {
                joint: model.machine.cylinders[number].linkage.joint(motion.value(displacement)),
                velocity,
                pressures: [
                    parabolas.pressure(&measured.cap_pressure, *cap_noise),
                    parabolas.pressure(&measured.rod_pressure, *rod_noise),
                ],
            }
        };
        let pump_pressure = parabolas.pressure(&recording.pump_pressure, pump_noise);
        system.set_measured(known, pump_pressure, &mut state);
        // If it is not measured, the machine's constant is already set.
        if matches!(model.machine.supply, Supply::PressureSource(_)) && pump_pressure.is_finite() {
            inputs.supply_pressure = pump_pressure;
        }
        if state.iter().all(|value| value.is_finite()) {
            entries.push(sample, block.start + recording.time[sample], inputs.supply_pressure, &state);
        }
    }
    Ok(entries)
}

/// States, except the memory states of effects, with their inputs.
pub(super) struct Entries {
    signals: InputSignals,
    /// Number of each sample, its time since the start of the recording (s), and the supply's pressure (Pa).
    samples: Vec<(usize, f64, f64)>,
    /// The states, concatenated.
    states: Vec<f64>,
    states_each: usize,
}

impl Entries {
    fn new(system: &System<'_>, signals: InputSignals) -> Self {
        Entries { signals, samples: Vec::new(), states: Vec::new(), states_each: system.layout().len }
    }

    fn push(&mut self, sample: usize, time: f64, supply_pressure: f64, state: &[f64]) {
        self.samples.push((sample, time, supply_pressure));
        self.states.extend_from_slice(state);
    }
}

/// The books of a set of entries, in order.
pub(super) fn books_of(system: &System<'_>, parameters: &[f64], entries: &Entries) -> Books {
    let model = system.model();
    let (mut books, mut laws) = (Books::new(model, entries.samples.len()), LawStates::new(system));
    let mut accountant = Accountant::new(system);
    let mut inputs = Inputs::zero(model.machine.cylinders.len());
    let mut state = vec![0.0; system.layout().len];
    for (&(sample, time, supply_pressure), known) in
        entries.samples.iter().zip(entries.states.chunks_exact(entries.states_each))
    {
        entries.signals.between(sample, 0.0, &mut inputs);
        inputs.time = time;
        inputs.supply_pressure = supply_pressure;
        state.copy_from_slice(known);
        laws.follow(system, parameters, time, &inputs, &mut state);
        if state.iter().all(|value| value.is_finite()) {
            let ledger = accountant.ledger(parameters, &state, &inputs);
            books.enter(model, system.layout(), &ledger, &state, &inputs);
        }
    }
    books
}

/// The books of the measured states of a block.
pub(super) fn measured_books(
    system: &System<'_>,
    parameters: &[f64],
    block: &Block,
    settings: &EnergySettings,
) -> Result<Books, SignalError> {
    Ok(books_of(system, parameters, &measured(system, block, settings)?))
}

/// The books of a simulation on the clock of a block, from its states without smoothing.
pub(super) fn simulated_books(system: &System<'_>, block: &Block, simulated: &Recording) -> Result<Books, SignalError> {
    let model = system.model();
    let layout = system.layout();
    let parameters = model.parameter_values();
    let truth = undistorted(model, simulated);
    let signals = InputSignals::from_recording(model, &block.recording)?;
    let machine = model.machine.cylinders.iter();
    let cylinders = machine.map(|cylinder| truth.cylinder(&cylinder.name)).collect::<Result<Vec<_>, _>>()?;
    let (mut state, mut inputs) = (vec![0.0; layout.len], Inputs::zero(model.machine.cylinders.len()));
    let mut entries = Entries::new(system, signals);
    for sample in block.entries() {
        entries.signals.between(sample, 0.0, &mut inputs);
        let known = |number: usize| {
            let own = cylinders[number];
            KnownCylinder {
                joint: model.machine.cylinders[number].linkage.joint(own.displacement[sample]),
                velocity: own.velocity[sample],
                pressures: [own.cap_pressure[sample], own.rod_pressure[sample]],
            }
        };
        system.set_measured(known, truth.pump_pressure[sample], &mut state);
        entries.push(sample, block.start + truth.time[sample], inputs.supply_pressure, &state);
    }
    Ok(books_of(system, &parameters, &entries))
}
