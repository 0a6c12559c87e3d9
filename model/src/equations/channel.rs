//! Output channels of a model that instruments can measure.

use serde::{Deserialize, Serialize};

use super::{Layout, System};
use crate::effects::Number;
use crate::machine::Machine;
use crate::recording::{CylinderSignals, Recording};
use crate::scalar::{constant, derivative, variable};

/// One measurable output of a model. Cylinders are given by their index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Channel {
    /// Joint coordinate, rad (m for a linear load).
    JointAngle(usize),
    /// Piston displacement from mid-stroke, m.
    Displacement(usize),
    /// Piston velocity, m/s.
    Velocity(usize),
    /// Cap side pressure, Pa.
    CapPressure(usize),
    /// Rod side pressure, Pa.
    RodPressure(usize),
    /// Force on the rod, N; an output only where the motion is imposed.
    RodForce(usize),
    /// Pump pressure, Pa.
    PumpPressure,
}

impl Channel {
    /// Every channel of a model with this layout, cylinder after cylinder.
    pub fn all(layout: &Layout) -> Vec<Channel> {
        let mut channels = Vec::new();
        for cylinder in 0..layout.joints {
            channels.extend([Channel::JointAngle(cylinder), Channel::Displacement(cylinder)]);
            channels.push(Channel::Velocity(cylinder));
            if layout.chambers {
                channels.extend([Channel::CapPressure(cylinder), Channel::RodPressure(cylinder)]);
            }
            channels.extend(layout.rod_forces.map(|_| Channel::RodForce(cylinder)));
        }
        channels.extend(layout.pump.map(|_| Channel::PumpPressure));
        channels
    }

    /// Contract name of the signal: `arm.displacement`, `pump_pressure`.
    pub fn name(self, machine: &Machine) -> String {
        let of = |cylinder: usize, signal: &str| {
            format!("{}.{signal}", machine.cylinders.get(cylinder).map_or("?", |cylinder| cylinder.name.as_str()))
        };
        match self {
            Channel::JointAngle(cylinder) => of(cylinder, "joint_angle"),
            Channel::Displacement(cylinder) => of(cylinder, "displacement"),
            Channel::Velocity(cylinder) => of(cylinder, "velocity"),
            Channel::CapPressure(cylinder) => of(cylinder, "cap_pressure"),
            Channel::RodPressure(cylinder) => of(cylinder, "rod_pressure"),
            Channel::RodForce(cylinder) => of(cylinder, "rod_force"),
            Channel::PumpPressure => "pump_pressure".to_string(),
        }
    }

    /// The signal of a recording that reports this channel; `None` if the recording lacks the cylinder.
    pub fn signal_mut<'r>(self, machine: &Machine, recording: &'r mut Recording) -> Option<&'r mut Vec<f64>> {
        let (cylinder, signal): (usize, fn(&mut CylinderSignals) -> &mut Vec<f64>) = match self {
            Channel::JointAngle(cylinder) => (cylinder, |signals| &mut signals.joint_angle),
            Channel::Displacement(cylinder) => (cylinder, |signals| &mut signals.displacement),
            Channel::Velocity(cylinder) => (cylinder, |signals| &mut signals.velocity),
            Channel::CapPressure(cylinder) => (cylinder, |signals| &mut signals.cap_pressure),
            Channel::RodPressure(cylinder) => (cylinder, |signals| &mut signals.rod_pressure),
            Channel::RodForce(cylinder) => (cylinder, |signals| &mut signals.rod_force),
            Channel::PumpPressure => return Some(&mut recording.pump_pressure),
        };
        let name = &machine.cylinders.get(cylinder)?.name;
        recording.cylinders.iter_mut().find(|signals| signals.name == *name).map(signal)
    }

    /// The true value at a state (in the order of the layout); `NaN` if the model has no such state.
    pub fn value<T: Number>(self, system: &System<'_>, state: &[T]) -> T {
        let layout = system.layout();
        let linkage = |cylinder: usize| &system.model().machine.cylinders[cylinder].linkage;
        let at = |index: Option<usize>| index.map_or(T::from(f64::NAN), |index| state[index]);
        match self {
            Channel::JointAngle(c) => state[layout.joint(c)],
            Channel::Displacement(c) => linkage(c).displacement(state[layout.joint(c)]),
            Channel::Velocity(c) => linkage(c).lever(state[layout.joint(c)]) * state[layout.rate(c)],
            Channel::CapPressure(c) => at(layout.cap_pressure(c)),
            Channel::RodPressure(c) => at(layout.rod_pressure(c)),
            Channel::RodForce(c) => at(layout.rod_force(c)),
            Channel::PumpPressure => at(layout.pump),
        }
    }

    /// Derivative of the true value with respect to the state: pairs of state index and factor, the second factor
    /// often zero.
    pub fn gradient(self, system: &System<'_>, state: &[f64]) -> [(usize, f64); 2] {
        let layout = system.layout();
        let single = |index: Option<usize>| index.map_or([(0, 0.0); 2], |index| [(index, 1.0), (index, 0.0)]);
        match self {
            Channel::JointAngle(c) => single(Some(layout.joint(c))),
            Channel::Displacement(c) | Channel::Velocity(c) => {
                let linkage = &system.model().machine.cylinders[c].linkage;
                let (joint, rate) = (variable(state[layout.joint(c)], 0), state[layout.rate(c)]);
                let slopes = if matches!(self, Channel::Displacement(_)) {
                    (derivative(&linkage.displacement(joint), 0), 0.0)
                } else {
                    let lever = linkage.lever(joint);
                    (derivative(&(lever * constant(rate)), 0), lever.re)
                };
                [(layout.joint(c), slopes.0), (layout.rate(c), slopes.1)]
            }
            Channel::CapPressure(c) => single(layout.cap_pressure(c)),
            Channel::RodPressure(c) => single(layout.rod_pressure(c)),
            Channel::RodForce(c) => single(layout.rod_force(c)),
            Channel::PumpPressure => single(layout.pump),
        }
    }
}
