//! Measured signals of a recording that a simulation is compared with.

use excavator_model::equations::{Channel, System};
use excavator_model::machine::Machine;
use excavator_model::recording::{Recording, is_measured, noise_level, standard_deviation};

/// One measured output of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Instrument {
    /// Contract name: `arm.displacement`, `pump_pressure`.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// What it measures.
    pub channel: Channel,
    /// Standard deviation of its noise, estimated from the recordings, in its unit.
    pub noise: f64,
}

impl Instrument {
    /// The instrument of a machine that measures this, with this noise.
    pub(crate) fn new(channel: Channel, machine: &Machine, noise: f64) -> Self {
        Instrument { name: channel.name(machine), unit: unit(channel), channel, noise }
    }
}

/// Lower bound of the noise as a fraction of the signal's own standard deviation. Without it a noiseless (simulated)
/// signal would have infinite weight, and no integrator is exact beyond it.
const LEAST_RELATIVE_NOISE: f64 = 1e-4;

/// The instruments for the outputs of a model that all `recordings` share, with their noise.
pub fn instruments(system: &System<'_>, recordings: &[&Recording]) -> Vec<Instrument> {
    let machine = &system.model().machine;
    let mut channels = Channel::all(system.layout());
    if system.layout().rod_forces.is_some() {
        // An imposed motion is not an output.
        channels.retain(|channel| matches!(channel, Channel::RodForce(_)));
    }
    // A position counts once: as the displacement if that is measured, otherwise as the joint angle.
    let (angles, others): (Vec<Channel>, Vec<Channel>) =
        channels.into_iter().partition(|channel| matches!(channel, Channel::JointAngle(_)));
    let mut found: Vec<Instrument> = Vec::new();
    for channel in others.into_iter().chain(angles) {
        if let Channel::JointAngle(index) = channel
            && found.iter().any(|instrument| instrument.channel == Channel::Displacement(index))
        {
            continue;
        }
        let name = channel.name(machine);
        let signals: Vec<&[f64]> = recordings.iter().filter_map(|recording| recording.signal(&name)).collect();
        if signals.len() == recordings.len() && signals.iter().all(|signal| is_measured(signal)) {
            let noise = signals.iter().map(|signal| noise_level(signal)).fold(0.0, f64::max);
            let spread = signals.iter().map(|signal| standard_deviation(signal)).fold(0.0, f64::max);
            let floor = (LEAST_RELATIVE_NOISE * spread).max(f64::MIN_POSITIVE);
            found.push(Instrument::new(channel, machine, noise.max(floor)));
        }
    }
    found
}

fn unit(channel: Channel) -> &'static str {
    match channel {
        Channel::JointAngle(_) => "rad",
        Channel::Displacement(_) => "m",
        Channel::Velocity(_) => "m/s",
        Channel::RodForce(_) => "N",
        Channel::CapPressure(_) | Channel::RodPressure(_) | Channel::PumpPressure => "Pa",
    }
}
