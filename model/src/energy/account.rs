//! Computes the energy ledger of a state.

use super::oil::stored_beside;
use super::{CylinderStorage, EffectPower, Ledger, OilEnergy};
use crate::effects::{Number, Site};
use crate::equations::{Inputs, Rows, Situation, System, Workspace};
use crate::machine::Supply;

/// Storage and powers of a model at one instant: parameters in the model's order, state in the order of its layout. Many instants are
/// cheaper with an [`Accountant`].
///
/// ```
/// use excavator_model::equations::Inputs;
/// use excavator_model::prelude::*;
///
/// let model = built_in("zx30u-arm")?;
/// let system = System::new(&model);
/// let mut inputs = Inputs::zero(1);
/// inputs.pump_flow = 3.8e-4; // m³/s
/// let state = rest_state(&system, &[0.1], &inputs);
/// let book = ledger(&system, &model.parameter_values(), &state, &inputs);
/// // Nothing moves, and oil runs to the tank.
/// assert_eq!(book.cylinders[0].kinetic, 0.0); // J
/// assert!(book.bypass_loss() > 0.0); // W
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn ledger<'m, T: Number>(system: &System<'m>, parameters: &[T], state: &[T], inputs: &Inputs<T>) -> Ledger<T> {
    Accountant::new(system).ledger(parameters, state, inputs)
}

/// Computes ledgers of one model and reuses memory between calls.
#[derive(Debug)]
pub struct Accountant<'m, 's, T> {
    system: &'s System<'m>,
    workspace: Workspace<'m, T>,
    rates: Vec<T>,
    /// Contributions of all effects to the rows.
    totals: Rows<T>,
    /// Contribution of each effect alone.
    alone: Vec<Rows<T>>,
}

impl<'m, 's, T: Number> Accountant<'m, 's, T> {
    /// For the model of `system`.
    pub fn new(system: &'s System<'m>) -> Self {
        let layout = system.layout();
        Accountant {
            system,
            workspace: system.workspace(),
            rates: vec![T::from(0.0); layout.len],
            totals: Rows::zero(layout.joints),
            alone: vec![Rows::zero(layout.joints); system.model().effects.len()],
        }
    }

    /// Storage and powers at one instant: parameters in the model's order, state in the order of its layout.
    pub fn ledger(&mut self, parameters: &[T], state: &[T], inputs: &Inputs<T>) -> Ledger<T> {
        // The rates are evaluated for the situation, which may include metering flows, and for the mass matrix.
        self.system.rates(&mut self.workspace, parameters, state, inputs, &mut self.rates);
        std::mem::swap(&mut self.totals, &mut self.workspace.rows);
        for (number, alone) in self.alone.iter_mut().enumerate() {
            self.workspace.rows.clear();
            self.system.contribute_one(number, &mut self.workspace, parameters, state);
            std::mem::swap(alone, &mut self.workspace.rows);
        }
        std::mem::swap(&mut self.totals, &mut self.workspace.rows);
        let Accountant { system, workspace, alone, .. } = self;
        let mut account = Account { system, parameters, state, workspace, alone };
        account.ledger(inputs)
    }
}

/// One volume of oil.
#[derive(Clone, Copy)]
enum Oil {
    Cap(usize),
    Rod(usize),
    PumpLine,
}

impl Oil {
    fn set_pressure<T>(self, situation: &mut Situation<'_, T>, pressure: T) {
        match self {
            Oil::Cap(index) => situation.pistons[index].cap_pressure = pressure,
            Oil::Rod(index) => situation.pistons[index].rod_pressure = pressure,
            Oil::PumpLine => situation.pump_pressure = pressure,
        }
    }

    fn compliance<T: Copy>(self, rows: &Rows<T>) -> T {
        match self {
            Oil::Cap(index) => rows.cap_compliance[index],
            Oil::Rod(index) => rows.rod_compliance[index],
            Oil::PumpLine => rows.pump_compliance,
        }
    }
}

struct Account<'m, 'a, T> {
    system: &'a System<'m>,
    parameters: &'a [T],
    state: &'a [T],
    workspace: &'a mut Workspace<'m, T>,
    /// Contribution of each effect alone to the rows.
    alone: &'a [Rows<T>],
}

impl<T: Number> Account<'_, '_, T> {
    fn ledger(&mut self, inputs: &Inputs<T>) -> Ledger<T> {
        let zero = T::from(0.0);
        let mut cylinders = self.mechanical_storage();
        let mut potentials = Vec::with_capacity(cylinders.len());
        for (index, storage) in cylinders.iter_mut().enumerate() {
            let piston = self.workspace.situation.pistons[index];
            if self.workspace.situation.chambers(index).is_none() {
                potentials.push((zero, zero));
                continue;
            }
            let cap = self.oil(Oil::Cap(index), piston.cap_pressure, piston.cap_volume);
            let rod = self.oil(Oil::Rod(index), piston.rod_pressure, piston.rod_volume);
            storage.cap_internal = cap.stored * piston.cap_volume;
            storage.rod_internal = rod.stored * piston.rod_volume;
            potentials.push((cap.potential, rod.potential));
        }
        let supply_pressure = self.workspace.situation.pump_pressure;
        let (pump_line, pump_potential) = match self.system.model().machine.supply {
            Supply::PumpLine(line) => {
                let oil = self.oil(Oil::PumpLine, supply_pressure, T::from(line.volume));
                (oil.stored * line.volume + self.stored_in_accumulators(supply_pressure, line.volume), oil.potential)
            }
            // A supply pressure given from outside has no volume and stores nothing.
            Supply::PressureSource(_) => (zero, supply_pressure),
            Supply::None => (zero, zero),
        };
        let effects = self.effect_powers(&potentials, pump_potential);

        let pump_power = match self.system.model().machine.supply {
            Supply::PumpLine(_) => pump_potential * inputs.pump_flow,
            Supply::PressureSource(_) | Supply::None => effects.iter().fold(zero, |sum, effect| sum - effect.pump_line),
        };
        let pistons = self.workspace.situation.pistons.iter().zip(&self.system.model().machine.cylinders);
        let rod_force_power = pistons
            .filter(|(_, cylinder)| cylinder.chambers.is_none())
            .fold(zero, |sum, (piston, _)| sum + piston.rod_force * piston.velocity);
        let machine = &self.system.model().machine;
        let motors = machine.cylinders.iter().enumerate().filter(|(_, cylinder)| cylinder.is_motor());
        let expansion_loss = motors.fold(zero, |sum, (index, _)| {
            let (piston, (cap, rod)) = (&self.workspace.situation.pistons[index], potentials[index]);
            let Some(chambers) = self.workspace.situation.chambers(index) else { return sum };
            let stored = [cap - piston.cap_pressure, rod - piston.rod_pressure];
            sum + (stored[0] * chambers.cap_area - stored[1] * chambers.rod_area) * piston.velocity
        });
        Ledger { cylinders, pump_line, effects, pump_power, rod_force_power, expansion_loss }
    }

    /// Contribution of effect `number` alone to the rows, in a changed situation.
    fn contribute_alone(&mut self, number: usize) {
        self.workspace.rows.clear();
        self.system.contribute_one(number, self.workspace, self.parameters, self.state);
    }

    /// Kinetic and potential energy of each joint, \[A\] Eq. 9, from rows with the contributions of all effects.
    fn mechanical_storage(&self) -> Vec<CylinderStorage<T>> {
        let zero = T::from(0.0);
        let Workspace { situation, rows, .. } = &*self.workspace;
        let mut storage: Vec<CylinderStorage<T>> = kinetic_energies(situation, rows)
            .map(|kinetic| CylinderStorage { kinetic, potential: zero, cap_internal: zero, rod_internal: zero })
            .collect();
        for (effect, &(first, last)) in self.system.model().effects.iter().zip(self.system.parameter_ranges()) {
            let stored = T::hooks(&*effect.physics).potential(effect.site, &self.parameters[first..last], situation);
            if let (Some(potential), Site::Cylinder(index)) = (stored, effect.site) {
                storage[index].potential += potential;
            }
        }
        storage
    }

    /// Energy of one volume of oil, from the compliances of all effects, integrated up to its pressure.
    fn oil(&mut self, oil: Oil, pressure: T, volume: T) -> OilEnergy<T> {
        let stiffens = |number: &usize| oil.compliance(&self.alone[*number]).value() != 0.0;
        let springs: Vec<usize> = (0..self.alone.len()).filter(stiffens).collect();
        let constant =
            springs.iter().all(|&number| self.system.model().effects[number].physics.has_constant_compliance());
        if constant {
            let compliance =
                springs.iter().fold(T::from(0.0), |sum, &number| sum + oil.compliance(&self.alone[number]));
            return OilEnergy::of_constant(compliance / volume, pressure);
        }
        let mut compressibility = |pressure: T| {
            oil.set_pressure(&mut self.workspace.situation, pressure);
            springs.iter().fold(T::from(0.0), |sum, &number| {
                self.contribute_alone(number);
                sum + oil.compliance(&self.workspace.rows)
            }) / volume
        };
        let energy = OilEnergy::of_varying(&mut compressibility, pressure);
        oil.set_pressure(&mut self.workspace.situation, pressure);
        energy
    }

    /// Energy of the gas in accumulators on a pump line of this oil volume (m³).
    fn stored_in_accumulators(&mut self, pressure: T, volume: f64) -> T {
        let has_gas = |number: &usize| self.alone[*number].accumulator_compliance.value() != 0.0;
        let accumulators: Vec<usize> = (0..self.alone.len()).filter(has_gas).collect();
        if accumulators.is_empty() {
            return T::from(0.0);
        }
        let stored = stored_beside(
            |pressure| {
                let potential = self.oil(Oil::PumpLine, pressure, T::from(volume)).potential;
                Oil::PumpLine.set_pressure(&mut self.workspace.situation, pressure);
                let compliance = accumulators.iter().fold(T::from(0.0), |sum, &number| {
                    self.contribute_alone(number);
                    sum + self.workspace.rows.accumulator_compliance
                });
                (compliance, potential)
            },
            pressure,
        );
        Oil::PumpLine.set_pressure(&mut self.workspace.situation, pressure);
        stored
    }

    /// Power of each effect; `potentials` are e(p+) and e(p-) of each cylinder, `pump_potential` is e(pp).
    fn effect_powers(&mut self, potentials: &[(T, T)], pump_potential: T) -> Vec<EffectPower<T>> {
        let zero = T::from(0.0);
        (0..self.system.model().effects.len())
            .map(|number| {
                let effect = &self.system.model().effects[number];
                let (first, last) = self.system.parameter_ranges()[number];
                let (situation, rows) = (&self.workspace.situation, &self.alone[number]);
                let parameters = &self.parameters[first..last];
                // The torque of an effect with mass is its Coriolis torque, whose power is the change of the mass matrix.
                let has_mass = rows.mass.iter().any(|entry| entry.value() != 0.0);
                let has_weight = T::hooks(&*effect.physics).potential(effect.site, parameters, situation).is_some();
                let has_spring = rows.cap_compliance.iter().chain(&rows.rod_compliance).any(|c| c.value() != 0.0)
                    || rows.pump_line_compliance().value() != 0.0;
                let (mut mechanical, mut cap, mut rod) = (zero, zero, zero);
                for (index, piston) in situation.pistons.iter().enumerate() {
                    if !(has_mass || has_weight) {
                        mechanical += rows.torque[index] * piston.rate;
                    }
                    mechanical += rows.piston_force[index] * piston.velocity;
                    cap += rows.cap_flow[index] * potentials[index].0;
                    rod += rows.rod_flow[index] * potentials[index].1;
                }
                let acts_on = effect.physics.card().acts_on;
                let mut pump_line = rows.pump_flow * pump_potential;
                if effect.physics.takes_power_from_a_shaft() {
                    pump_line -= cap + rod;
                }
                if (has_mass || has_weight) && !effect.acts_always() {
                    mechanical += self.carried_power(number);
                }
                let only_stores = (has_mass || has_weight || has_spring) && effect.acts_always();
                EffectPower {
                    effect: effect.name_text(),
                    site: effect.site,
                    acts_on,
                    has_power: effect.physics.has_power() && !only_stores,
                    mechanical,
                    cap,
                    rod,
                    pump_line,
                }
            })
            .collect()
    }

    /// Power of a mass that is picked up or put down, W: the rate of the energy that effect `number` stores, with everything
    /// constant except time.
    fn carried_power(&mut self, number: usize) -> T {
        let now = self.workspace.situation.time;
        let instant = INSTANT * self.system.model().machine.size().time();
        let mut stored_at = |time: T| {
            self.workspace.situation.time = time;
            self.contribute_alone(number);
            let effect = &self.system.model().effects[number];
            let (first, last) = self.system.parameter_ranges()[number];
            let Workspace { situation, rows, .. } = &*self.workspace;
            let potential = T::hooks(&*effect.physics).potential(effect.site, &self.parameters[first..last], situation);
            kinetic_energies(situation, rows).fold(potential.unwrap_or(T::from(0.0)), |sum, part| sum + part)
        };
        let near = stored_at(now + instant) - stored_at(now - instant);
        let far = stored_at(now + 2.0 * instant) - stored_at(now - 2.0 * instant);
        let power = (near * 8.0 - far) / (12.0 * instant);
        self.workspace.situation.time = now;
        power
    }
}

/// Step of the finite differences in time, s: a thousandth of a window's edge, so that their error is about 1e-12.
const INSTANT: f64 = 3e-5;

/// Kinetic energy of each joint, \[A\] Eq. 9, J.
fn kinetic_energies<T: Number>(situation: &Situation<'_, T>, rows: &Rows<T>) -> impl Iterator<Item = T> {
    let pistons = &situation.pistons;
    (0..pistons.len()).map(move |row| {
        let momentum =
            (0..pistons.len()).fold(T::from(0.0), |sum, column| sum + rows.mass_at(row, column) * pistons[column].rate);
        momentum * pistons[row].rate * 0.5
    })
}
