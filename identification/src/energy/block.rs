//! A stretch of a recording, and the books of what was measured in it.

use excavator_model::SignalError;
use excavator_model::energy::Accountant;
use excavator_model::equations::{Inputs, LawStates, System};
use excavator_model::machine::Supply;
use excavator_model::recording::{Recording, is_measured};
use excavator_model::simulation::{InputSignals, undistorted};

use super::smoothing::Parabola;
use super::{Books, EnergySettings};

/// A stretch without gaps. Its entries are those samples whose number in the recording is a multiple of `stride`, so that
/// neighbouring blocks that overlap have the same.
#[derive(Debug, Clone)]
pub(super) struct Block {
    /// The samples, with what the windows at the ends need.
    pub recording: Recording,
    /// Time of the first sample since the start of the recording, s.
    pub start: f64,
    /// Number of the first sample in the recording.
    pub first_sample: usize,
    /// Samples per entry.
    pub stride: usize,
    /// Part that counts, s since the start of the recording.
    pub own: (f64, f64),
    /// Whether valve openings may come from the spool sensor alone. The estimate that also listens to the command is a
    /// little sharper and takes longer than everything else together.
    pub quick: bool,
    /// Whether the effect of noise is found out by repeats.
    pub with_noise: bool,
}

impl Block {
    /// Numbers of the samples that have an entry.
    fn entries(&self) -> impl Iterator<Item = usize> + use<> {
        let first = self.first_sample.next_multiple_of(self.stride) - self.first_sample;
        (first..self.recording.len()).step_by(self.stride)
    }
}

/// The books of what was measured: positions and pressures by parabolas through their samples, valves by the estimate that
/// drives simulations too. Entries whose windows are cut off by the ends or touch a sample that was not measured are not
/// there.
pub(super) fn measured_books(
    system: &System<'_>,
    parameters: &[f64],
    block: &Block,
    settings: &EnergySettings,
) -> Result<Books, SignalError> {
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
            Ok((displacement, signals))
        })
        .collect::<Result<Vec<_>, SignalError>>()?;
    let (mut books, mut laws, mut accountant) = (Books::new(model), LawStates::new(system), Accountant::new(system));
    let mut state = vec![0.0; layout.len];
    let mut inputs = Inputs::zero(model.machine.cylinders.len());
    let (mut motion, mut pressure) = (Parabola::default(), Parabola::default());
    for sample in block.entries() {
        if !motion.set(&recording.time, sample, settings.motion_half_width)
            || !pressure.set(&recording.time, sample, settings.half_width)
        {
            continue;
        }
        signals.between(sample, 0.0, &mut inputs);
        inputs.time = block.start + recording.time[sample];
        for (number, (cylinder, (displacement, measured))) in model.machine.cylinders.iter().zip(&sources).enumerate() {
            let joint = cylinder.linkage.joint(motion.value(displacement));
            let velocity = match measured.velocity[sample] {
                known if known.is_finite() => pressure.value(&measured.velocity),
                _ => motion.slope(displacement),
            };
            let pressures = [&measured.cap_pressure, &measured.rod_pressure].map(|signal| pressure.value(signal));
            system.set_cylinder(number, joint, velocity, pressures, &mut state);
        }
        match (layout.pump, model.machine.supply) {
            (Some(pump), _) => state[pump] = pressure.value(&recording.pump_pressure),
            (None, Supply::PressureSource(_)) => {
                // Where it is not measured the machine's constant is there already.
                let measured = pressure.value(&recording.pump_pressure);
                if measured.is_finite() {
                    inputs.supply_pressure = measured;
                }
            }
            (None, _) => {}
        }
        laws.follow(system, parameters, inputs.time, &inputs, &mut state);
        enter(system, &mut accountant, parameters, &state, &inputs, &mut books);
    }
    Ok(books)
}

/// The books of a simulation on the clock of a block: its states as they are.
pub(super) fn simulated_books(system: &System<'_>, block: &Block, simulated: &Recording) -> Result<Books, SignalError> {
    let model = system.model();
    let layout = system.layout();
    let parameters = model.parameter_values();
    let truth = undistorted(model, simulated);
    let signals = InputSignals::from_recording(model, &block.recording)?;
    let (mut books, mut laws, mut accountant) = (Books::new(model), LawStates::new(system), Accountant::new(system));
    let mut state = vec![0.0; layout.len];
    let mut inputs = Inputs::zero(model.machine.cylinders.len());
    for sample in block.entries() {
        signals.between(sample, 0.0, &mut inputs);
        inputs.time = block.start + truth.time[sample];
        for (number, cylinder) in model.machine.cylinders.iter().enumerate() {
            let own = truth.cylinder(&cylinder.name)?;
            let joint = cylinder.linkage.joint(own.displacement[sample]);
            let pressures = [own.cap_pressure[sample], own.rod_pressure[sample]];
            system.set_cylinder(number, joint, own.velocity[sample], pressures, &mut state);
        }
        if let Some(pump) = layout.pump {
            state[pump] = truth.pump_pressure[sample];
        }
        laws.follow(system, &parameters, inputs.time, &inputs, &mut state);
        enter(system, &mut accountant, &parameters, &state, &inputs, &mut books);
    }
    Ok(books)
}

fn enter(
    system: &System<'_>,
    accountant: &mut Accountant<'_, '_, f64>,
    parameters: &[f64],
    state: &[f64],
    inputs: &Inputs<f64>,
    books: &mut Books,
) {
    if state.iter().all(|value| value.is_finite()) {
        let ledger = accountant.ledger(parameters, state, inputs);
        books.enter(system.model(), system.layout(), &ledger, state, inputs);
    }
}
