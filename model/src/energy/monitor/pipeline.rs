//! Computes balances from measured states.

use std::collections::VecDeque;

use super::slope::slope_at;
use super::{Balance, CylinderBalance, EffectTerm};
use crate::Model;
use crate::effects::{ActsOn, Site};
use crate::energy::Accountant;
use crate::equations::{Inputs, KnownCylinder, LawStates, System};
use crate::machine::Supply;
use crate::recording::{CylinderSample, Sample};

/// Settings for differentiation and for gaps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Half width of the window of a slope, s. 10 ms: at 1 kHz it averages 21 samples, and passes 97 % of the
    /// amplitude of an arm's energy, which changes within 50 ms at the fastest.
    pub half_width: f64,
    /// A pause longer than this counts as a gap, s: windows do not reach across it.
    pub gap: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { half_width: 0.01, gap: 0.1 }
    }
}

/// Counters of the monitor.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Counts {
    /// States received.
    pub states: u64,
    /// Balances returned.
    pub balances: u64,
    /// States with the same timestamp as the previous one, dropped.
    pub duplicates: u64,
    /// States older than the previous one, dropped.
    pub out_of_order: u64,
    /// Gaps, after which windows start again.
    pub gaps: u64,
    /// Backward jumps of the clock, after which windows start again.
    pub jumps: u64,
    /// Balances with a `NaN` because a signal was missing.
    pub incomplete: u64,
}

/// Rounding of times, s: less than any sample interval, more than the rounding error of doubles within a day.
const ROUNDING: f64 = 1e-9;
/// A state older than the newest by more than this is a jump of the clock, not a late message, ns.
const BACKWARDS: i64 = 1_000_000_000;

/// Monitors one machine.
#[derive(Debug)]
pub struct Monitor<'m, 's> {
    system: &'s System<'m>,
    parameters: Vec<f64>,
    settings: Settings,
    /// States whose balances are not complete, oldest first; the storage of the first `stored` is known.
    waiting: VecDeque<Waiting>,
    /// Entries of `waiting` whose balance was returned, kept for the windows of later states.
    given: usize,
    /// Entries of `waiting` whose storage and powers are known.
    evaluated: usize,
    laws: LawStates<'m>,
    accountant: Accountant<'m, 's, f64>,
    counts: Counts,
}

#[derive(Debug)]
struct Waiting {
    sample: Sample,
    /// Seconds since the first sample after a restart.
    time: f64,
    balance: Option<Balance>,
}

impl<'m, 's> Monitor<'m, 's> {
    /// A monitor for the machine of `system`, with the model's parameter values.
    pub fn new(system: &'s System<'m>, settings: Settings) -> Self {
        Monitor {
            system,
            parameters: system.model().parameter_values(),
            settings,
            waiting: VecDeque::new(),
            given: 0,
            evaluated: 0,
            laws: LawStates::new(system),
            accountant: Accountant::new(system),
            counts: Counts::default(),
        }
    }

    /// Delay of a balance behind its state, s: until the window of the Hamiltonian's rate is full, plus the window of
    /// the velocity if no sensor measures it.
    pub fn delay(&self, velocity_is_measured: bool) -> f64 {
        if velocity_is_measured { self.settings.half_width } else { 2.0 * self.settings.half_width }
    }

    /// The counters so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Adds a state. Balances that are now complete are appended to `balances`, in the order of their states.
    pub fn push(&mut self, sample: Sample, balances: &mut Vec<Balance>) {
        let mut first = sample.nanoseconds;
        if let Some(newest) = self.waiting.back().map(|waiting| waiting.sample.nanoseconds) {
            let step = sample.nanoseconds.saturating_sub(newest);
            if step == 0 {
                self.counts.duplicates += 1;
                return;
            }
            if (-BACKWARDS..0).contains(&step) {
                self.counts.out_of_order += 1;
                return;
            }
            if step < 0 || step as f64 * 1e-9 > self.settings.gap {
                let counter = if step < 0 { &mut self.counts.jumps } else { &mut self.counts.gaps };
                *counter += 1;
                self.flush(balances);
            } else if let Some(oldest) = self.waiting.front() {
                first = oldest.sample.nanoseconds - (oldest.time * 1e9) as i64;
            }
        }
        self.counts.states += 1;
        let time = sample.nanoseconds.saturating_sub(first) as f64 * 1e-9;
        self.waiting.push_back(Waiting { sample, time, balance: None });
        self.evaluate(time, false);
        self.give(time, false, balances);
        self.forget();
    }

    /// Returns the pending balances, with the windows available so far, and restarts.
    pub fn flush(&mut self, balances: &mut Vec<Balance>) {
        self.evaluate(f64::INFINITY, true);
        self.give(f64::INFINITY, true, balances);
        self.waiting.clear();
        self.given = 0;
        self.evaluated = 0;
    }

    /// Computes storage and powers of the states whose velocity can be known at time `now`.
    fn evaluate(&mut self, now: f64, all: bool) {
        while let Some(next) = self.waiting.get(self.evaluated) {
            let measured = self.has_velocity(&next.sample);
            if !all && !measured && next.time + self.settings.half_width > now + ROUNDING {
                return;
            }
            let (mut state, inputs) = self.state_of(next);
            let time = next.time;
            self.laws.follow(self.system, &self.parameters, time, &inputs, &mut state);
            let balance = self.balance(self.evaluated, &state, &inputs);
            if let Some(next) = self.waiting.get_mut(self.evaluated) {
                next.balance = Some(balance);
            }
            self.evaluated += 1;
        }
    }

    /// Computes rates of the Hamiltonian for the states whose window is full, and returns their balances.
    fn give(&mut self, now: f64, all: bool, balances: &mut Vec<Balance>) {
        while self.given < self.evaluated {
            let Some(next) = self.waiting.get(self.given) else { return };
            let reach = next.time + self.settings.half_width;
            // The window is full once the states after its end have been evaluated too.
            let known = self.waiting.get(self.evaluated.saturating_sub(1)).map_or(now, |last| last.time);
            if !all && known < reach - ROUNDING {
                return;
            }
            let centre = next.time;
            let Some(mut balance) = next.balance.clone() else { return };
            for (number, cylinder) in balance.cylinders.iter_mut().enumerate() {
                let energies = self.around(centre).filter_map(|waiting| {
                    let stored = waiting.balance.as_ref()?.cylinders.get(number)?.hamiltonian();
                    Some((waiting.time, stored))
                });
                cylinder.hamiltonian_rate = slope_at(energies, centre);
            }
            let complete = balance.cylinders.iter().all(|cylinder| cylinder.residual().is_finite());
            self.counts.incomplete += u64::from(!complete);
            self.counts.balances += 1;
            balances.push(balance);
            self.given += 1;
        }
    }

    /// Drops the states that no window needs.
    fn forget(&mut self) {
        while self.given > 0 {
            let (Some(oldest), Some(next)) = (self.waiting.front(), self.waiting.get(self.given)) else { return };
            if oldest.time >= next.time - 2.0 * self.settings.half_width {
                return;
            }
            self.waiting.pop_front();
            self.given -= 1;
            self.evaluated -= 1;
        }
    }

    /// The states within a half width of `centre`.
    fn around(&self, centre: f64) -> impl Iterator<Item = &Waiting> {
        // Slightly wider, so that rounding of timestamps does not make a window asymmetric.
        let half_width = self.settings.half_width + ROUNDING;
        self.waiting
            .iter()
            .skip_while(move |waiting| waiting.time < centre - half_width)
            .take_while(move |waiting| waiting.time <= centre + half_width)
    }

    fn has_velocity(&self, sample: &Sample) -> bool {
        sample.cylinders.iter().all(|cylinder| cylinder.velocity.is_finite())
    }

    /// Storage and powers at one state; the rate of the Hamiltonian follows later.
    fn balance(&mut self, index: usize, state: &[f64], inputs: &Inputs<f64>) -> Balance {
        let model: &Model = self.system.model();
        let book = self.accountant.ledger(&self.parameters, state, inputs);
        let waiting = &self.waiting[index];
        let cylinders = book
            .cylinders
            .iter()
            .enumerate()
            .map(|(number, storage)| {
                let own = || book.effects.iter().filter(move |effect| effect.site == Site::Cylinder(number));
                let valve: f64 =
                    own().filter(|effect| effect.acts_on == ActsOn::Valve).map(|effect| effect.into_cylinders()).sum();
                let oil = model.machine.cylinders.get(number).is_some_and(|cylinder| cylinder.chambers.is_some());
                let pushed = if oil { 0.0 } else { self.rod_power(state, inputs, number) };
                let terms = own()
                    .filter(|effect| effect.acts_on != ActsOn::Valve && effect.has_power)
                    .map(|effect| EffectTerm { effect: effect.effect.clone(), power: effect.into_cylinders() })
                    .collect();
                CylinderBalance {
                    kinetic: storage.kinetic,
                    potential: storage.potential,
                    cap_internal: storage.cap_internal,
                    rod_internal: storage.rod_internal,
                    hamiltonian_rate: f64::NAN,
                    supply: valve + pushed,
                    terms,
                }
            })
            .collect();
        Balance {
            nanoseconds: waiting.sample.nanoseconds,
            cylinders,
            pump_power: book.pump_power,
            bypass_loss: book.bypass_loss(),
            metering_loss: book.metering_loss(),
        }
    }

    fn rod_power(&self, state: &[f64], inputs: &Inputs<f64>, number: usize) -> f64 {
        let layout = self.system.layout();
        let cylinder = &self.system.model().machine.cylinders[number];
        inputs.rod_force[number] * cylinder.linkage.lever(state[layout.joint(number)]) * state[layout.rate(number)]
    }

    /// State vector, without the effects' own states, and inputs of a measured state.
    fn state_of(&self, waiting: &Waiting) -> (Vec<f64>, Inputs<f64>) {
        let layout = self.system.layout();
        let machine = &self.system.model().machine;
        let sample = &waiting.sample;
        let mut state = vec![0.0; layout.len];
        let mut inputs = Inputs::zero(machine.cylinders.len());
        let cylinder_sample =
            |number: usize| sample.cylinders.get(number).copied().unwrap_or_else(CylinderSample::unmeasured);
        let known = |number: usize| {
            let measured = cylinder_sample(number);
            let joint = if measured.displacement.is_finite() {
                machine.cylinders[number].linkage.joint(measured.displacement)
            } else {
                measured.joint_angle
            };
            let pressures = [measured.cap_pressure, measured.rod_pressure];
            KnownCylinder { joint, velocity: self.velocity(waiting, number), pressures }
        };
        self.system.set_measured(known, sample.pump_pressure, &mut state);
        for (number, cylinder) in machine.cylinders.iter().enumerate() {
            let measured = cylinder_sample(number);
            inputs.orifice_area[number] = if cylinder.chambers.is_some() { measured.orifice_area } else { 0.0 };
            inputs.rod_force[number] = if cylinder.chambers.is_some() { 0.0 } else { measured.rod_force };
        }
        let or = |value: f64, constant: f64| if value.is_finite() { value } else { constant };
        inputs.supply_pressure = match machine.supply {
            Supply::PressureSource(source) => or(sample.pump_pressure, source.pressure),
            Supply::PumpLine(_) | Supply::None => sample.pump_pressure,
        };
        inputs.tank_pressure = or(sample.tank_pressure, machine.supply.tank_pressure());
        inputs.pump_flow = or(sample.pump_flow, machine.supply.pump_flow());
        (state, inputs)
    }

    /// Piston velocity: measured, or the slope of the displacement.
    fn velocity(&self, waiting: &Waiting, number: usize) -> f64 {
        let of = |waiting: &Waiting| waiting.sample.cylinders.get(number).copied();
        let Some(measured) = of(waiting) else { return f64::NAN };
        if measured.velocity.is_finite() {
            return measured.velocity;
        }
        let linkage = &self.system.model().machine.cylinders[number].linkage;
        let positions = self.around(waiting.time).filter_map(|waiting| {
            let measured = of(waiting)?;
            let displacement = if measured.displacement.is_finite() {
                measured.displacement
            } else {
                linkage.displacement(measured.joint_angle)
            };
            Some((waiting.time, displacement))
        });
        slope_at(positions, waiting.time)
    }
}
