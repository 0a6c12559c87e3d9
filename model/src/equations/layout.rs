//! Positions of the states in the state vector.

use crate::Model;
use crate::machine::Supply;

/// Order of the state vector: joint coordinates q, joint rates, cap and rod pressure of each cylinder, pump pressure,
/// force on the rod of each cylinder whose motion is imposed, states of effects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Layout {
    /// Number of joints, which is also the number of cylinders.
    pub joints: usize,
    /// Whether cylinders have pressure states.
    pub chambers: bool,
    /// Index of the pump pressure.
    pub pump: Option<usize>,
    /// Index of the first cylinder's rod force, where motions are imposed.
    pub rod_forces: Option<usize>,
    /// First state of each effect and its number of states, in the model's order of effects.
    pub effect_states: Vec<(usize, usize)>,
    /// Number of states.
    pub len: usize,
}

impl Layout {
    /// The layout of a model's states.
    pub fn of(model: &Model) -> Self {
        let joints = model.machine.mechanism.joints();
        let chambers = model.machine.has_chambers();
        let mut len = 2 * joints + if chambers { 2 * joints } else { 0 };
        let pump = matches!(model.machine.supply, Supply::PumpLine(_)).then_some(len);
        len += usize::from(pump.is_some());
        let rod_forces = model.machine.has_imposed_motion().then_some(len);
        len += if rod_forces.is_some() { joints } else { 0 };
        let mut effect_states = Vec::with_capacity(model.effects.len());
        for effect in &model.effects {
            let states = effect.physics.states();
            effect_states.push((len, states));
            len += states;
        }
        Layout { joints, chambers, pump, rod_forces, effect_states, len }
    }

    /// Index of the joint coordinate q.
    pub fn joint(&self, joint: usize) -> usize {
        joint
    }

    /// Index of the joint rate.
    pub fn rate(&self, joint: usize) -> usize {
        self.joints + joint
    }

    /// Index of the cap side pressure; `None` without chambers.
    pub fn cap_pressure(&self, cylinder: usize) -> Option<usize> {
        self.chambers.then_some(2 * self.joints + 2 * cylinder)
    }

    /// Index of the force on the rod; `None` unless the motion is imposed.
    pub fn rod_force(&self, cylinder: usize) -> Option<usize> {
        self.rod_forces.map(|first| first + cylinder)
    }

    /// Index of the rod side pressure; `None` without chambers.
    pub fn rod_pressure(&self, cylinder: usize) -> Option<usize> {
        self.chambers.then_some(2 * self.joints + 2 * cylinder + 1)
    }

    /// Formats a state for messages: piston positions, pressures and rod forces.
    pub fn told(&self, model: &Model, state: &[f64]) -> String {
        let at = |index: Option<usize>| index.and_then(|index| state.get(index)).copied();
        let bar =
            |what: &str, pressure: Option<f64>| pressure.map(|pascals| format!("{what} {:.1} bar", pascals / 1e5));
        let cylinders = model.machine.cylinders.iter().enumerate().flat_map(|(number, cylinder)| {
            let joint = at(Some(self.joint(number))).unwrap_or(f64::NAN);
            let place = format!("{} at {:.1} mm", cylinder.name, 1e3 * cylinder.linkage.displacement(joint));
            let pressures = [
                bar("cap side", at(self.cap_pressure(number))),
                bar("rod side", at(self.rod_pressure(number))),
                at(self.rod_force(number)).map(|force| format!("{force:.0} N on the rod")),
            ];
            std::iter::once(place).chain(pressures.into_iter().flatten())
        });
        cylinders.chain(bar("pump", at(self.pump))).collect::<Vec<_>>().join(", ")
    }
}
