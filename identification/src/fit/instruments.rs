//! What of a recording a simulation is compared with.

use excavator_model::equations::{Layout, System};
use excavator_model::recording::{Recording, is_measured, noise_level};
use excavator_model::simulation::OutputSensitivity;

/// One measured output of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Instrument {
    /// Contract name: `arm.displacement`, `pump_pressure`.
    pub name: String,
    /// SI unit.
    pub unit: &'static str,
    /// What it measures.
    pub quantity: Quantity,
    /// Standard deviation of its noise, estimated from the recordings, in its unit.
    pub noise: f64,
}

/// A model output that an instrument can measure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Piston displacement of a cylinder.
    Displacement(usize),
    /// Piston velocity of a cylinder.
    Velocity(usize),
    /// Joint coordinate of a cylinder; used where displacement is not measured.
    JointAngle(usize),
    /// Cap side pressure.
    CapPressure(usize),
    /// Rod side pressure.
    RodPressure(usize),
    /// Pump pressure.
    PumpPressure,
}

/// Noise is never taken to be below this fraction of a signal's own standard deviation: a noiseless (simulated) signal
/// would otherwise have infinite weight, and no integrator is exact beyond it.
const LEAST_RELATIVE_NOISE: f64 = 1e-4;

/// The instruments that `recordings` have in common for the outputs of a model, with their noise.
pub fn instruments(system: &System<'_>, recordings: &[&Recording]) -> Vec<Instrument> {
    let machine = &system.model().machine;
    let layout = system.layout();
    let mut wanted: Vec<(String, &'static str, Quantity)> = Vec::new();
    for (index, cylinder) in machine.cylinders.iter().enumerate() {
        let name = |signal: &str| format!("{}.{signal}", cylinder.name);
        wanted.push((name("displacement"), "m", Quantity::Displacement(index)));
        wanted.push((name("velocity"), "m/s", Quantity::Velocity(index)));
        wanted.push((name("joint_angle"), "rad", Quantity::JointAngle(index)));
        if layout.chambers {
            wanted.push((name("cap_pressure"), "Pa", Quantity::CapPressure(index)));
            wanted.push((name("rod_pressure"), "Pa", Quantity::RodPressure(index)));
        }
    }
    if layout.pump.is_some() {
        wanted.push(("pump_pressure".into(), "Pa", Quantity::PumpPressure));
    }
    let mut found: Vec<Instrument> = Vec::new();
    for (name, unit, quantity) in wanted {
        if let Quantity::JointAngle(index) = quantity
            && found.iter().any(|instrument| instrument.quantity == Quantity::Displacement(index))
        {
            continue;
        }
        let signals: Vec<&[f64]> = recordings.iter().filter_map(|recording| recording.signal(&name)).collect();
        if signals.len() == recordings.len() && signals.iter().all(|signal| is_measured(signal)) {
            let noise = signals.iter().map(|signal| noise_level(signal)).fold(0.0, f64::max);
            let spread = signals.iter().map(|signal| standard_deviation(signal)).fold(0.0, f64::max);
            let floor = (LEAST_RELATIVE_NOISE * spread).max(f64::MIN_POSITIVE);
            found.push(Instrument { name, unit, quantity, noise: noise.max(floor) });
        }
    }
    found
}

/// Standard deviation of the finite values of a signal; 0 when there are none.
pub fn standard_deviation(signal: &[f64]) -> f64 {
    let finite = || signal.iter().filter(|value| value.is_finite());
    let count = finite().count() as f64;
    if count == 0.0 {
        return 0.0;
    }
    let mean = finite().sum::<f64>() / count;
    (finite().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt()
}

impl Instrument {
    /// What the instrument would read at a state.
    pub fn reading(&self, system: &System<'_>, state: &[f64]) -> f64 {
        let (layout, machine) = (system.layout(), &system.model().machine);
        let pressure = |index: Option<usize>| index.map_or(f64::NAN, |index| state[index]);
        match self.quantity {
            Quantity::Displacement(c) => machine.cylinders[c].linkage.displacement(state[layout.joint(c)]),
            Quantity::Velocity(c) => machine.cylinders[c].linkage.lever(state[layout.joint(c)]) * state[layout.rate(c)],
            Quantity::JointAngle(c) => state[layout.joint(c)],
            Quantity::CapPressure(c) => pressure(layout.cap_pressure(c)),
            Quantity::RodPressure(c) => pressure(layout.rod_pressure(c)),
            Quantity::PumpPressure => pressure(layout.pump),
        }
    }

    /// Derivative of the reading: pairs of state index and factor (at most two).
    pub fn gradient(&self, system: &System<'_>, state: &[f64]) -> [(usize, f64); 2] {
        let layout: &Layout = system.layout();
        let single = |index: usize| [(index, 1.0), (index, 0.0)];
        match self.quantity {
            Quantity::Displacement(c) => {
                let slope = OutputSensitivity::of(system, c, state).displacement_by_joint;
                [(layout.joint(c), slope), (layout.rate(c), 0.0)]
            }
            Quantity::Velocity(c) => {
                let slopes = OutputSensitivity::of(system, c, state);
                [(layout.joint(c), slopes.velocity_by_joint), (layout.rate(c), slopes.velocity_by_rate)]
            }
            Quantity::JointAngle(c) => single(layout.joint(c)),
            Quantity::CapPressure(c) => single(layout.cap_pressure(c).unwrap_or(0)),
            Quantity::RodPressure(c) => single(layout.rod_pressure(c).unwrap_or(0)),
            Quantity::PumpPressure => single(layout.pump.unwrap_or(0)),
        }
    }
}
