//! The equations of motion of a model, for any number type.

use std::ops::Range;

use super::rounding::NO_PRESSURE;
use super::{Inputs, Instruments, Layout, Rows, Situation};
use crate::effects::{ActsOn, Number, Site};
use crate::machine::{Growth, Size, Supply};
use crate::{Imposed, Model};

/// A model's equations of motion `dx/dt = f(x, inputs, parameters)`.
#[derive(Debug, Clone)]
pub struct System<'m> {
    pub(super) model: &'m Model,
    pub(super) layout: Layout,
    pub(super) parameter_ranges: Vec<(usize, usize)>,
    /// Effects that change the values other effects see.
    pub(super) adjusting: Vec<usize>,
    /// Effects that read the rate of the input.
    pub(super) readers_of_input_rate: Vec<usize>,
    /// Effects with memory.
    remembering: Vec<usize>,
    /// Whether an effect needs the metering flows.
    reads_metering_flows: bool,
    own_instruments: Instruments<f64>,
    /// Whether laws have their corners and effects that only confine the state are left out.
    pub(super) as_printed: bool,
    /// Size of each cylinder.
    pub(super) sizes: Vec<Size>,
    /// Size of the whole machine.
    size: Size,
}

/// Memory for one evaluation, reused so that evaluations do not allocate.
#[derive(Debug, Clone)]
pub struct Workspace<'m, T> {
    /// The values that the effects read at the last evaluation.
    pub situation: Situation<'m, T>,
    /// Contributions of the effects.
    pub rows: Rows<T>,
    mass: Vec<T>,
    torque: Vec<T>,
}

/// What is known of a cylinder at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownCylinder {
    /// Joint coordinate, rad or m.
    pub joint: f64,
    /// Piston velocity, m/s.
    pub velocity: f64,
    /// Pressures, Pa: cap side, rod side.
    pub pressures: [f64; 2],
}

impl<'m> System<'m> {
    /// The equations of a model.
    pub fn new(model: &'m Model) -> Self {
        let mut first = 0;
        let parameter_ranges = model
            .effects
            .iter()
            .map(|effect| {
                let range = (first, first + effect.parameters.len());
                first = range.1;
                range
            })
            .collect();
        let adjusting =
            (0..model.effects.len()).filter(|&number| model.effects[number].physics.adjusts_others()).collect();
        let readers_of_input_rate =
            (0..model.effects.len()).filter(|&number| model.effects[number].physics.reads_input_rate()).collect();
        let remembering =
            (0..model.effects.len()).filter(|&number| model.effects[number].physics.has_memory()).collect();
        let reads_metering_flows = model.effects.iter().any(|effect| effect.physics.reads_metering_flows());
        let own_instruments = Instruments::true_ones(model.machine.cylinders.len());
        let mut system = System {
            model,
            layout: Layout::of(model),
            parameter_ranges,
            adjusting,
            readers_of_input_rate,
            remembering,
            reads_metering_flows,
            own_instruments,
            as_printed: false,
            sizes: (0..model.machine.cylinders.len())
                .map(|index| model.machine.size_at(Site::Cylinder(index)))
                .collect(),
            size: model.machine.size(),
        };
        system.own_instruments = system.instruments(&model.parameter_values());
        system
    }

    /// The equations as \[A\] Eq. 4-7 print them: signs and roots are not rounded, and effects that only confine the state have no
    /// term. They are for regressions at measured states; a simulation needs the rounding.
    #[must_use]
    pub fn as_printed(mut self) -> Self {
        self.as_printed = true;
        self
    }

    /// The model.
    pub fn model(&self) -> &'m Model {
        self.model
    }

    /// Positions of the states.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// Whether an effect needs the metering flows.
    pub(super) fn reads_metering_flows(&self) -> bool {
        self.reads_metering_flows
    }

    /// Index of the effect that owns the parameter with this index.
    pub(super) fn owner(&self, parameter: usize) -> Option<usize> {
        self.parameter_ranges.iter().position(|&(first, last)| (first..last).contains(&parameter))
    }

    /// Index range of each effect's parameters in the model's parameter vector.
    pub fn parameter_ranges(&self) -> &[(usize, usize)] {
        &self.parameter_ranges
    }

    /// Memory for evaluations with number type `T`.
    pub fn workspace<T: Number>(&self) -> Workspace<'m, T> {
        let zero = T::from(0.0);
        let joints = self.layout.joints;
        let mut situation = Situation::empty(&self.model.machine);
        if self.as_printed {
            situation.bypass_transition = NO_PRESSURE;
        }
        Workspace { situation, rows: Rows::zero(joints), mass: vec![zero; joints * joints], torque: vec![zero; joints] }
    }

    /// Writes the time derivative of `state` (in the order of [`Layout`]) to `rates`.
    pub fn rates<T: Number>(
        &self,
        workspace: &mut Workspace<'m, T>,
        parameters: &[T],
        state: &[T],
        inputs: &Inputs<T>,
        rates: &mut [T],
    ) {
        self.observe(workspace, parameters, state, inputs, rates);
        workspace.rows.clear();
        if matches!(self.model.machine.supply, Supply::PumpLine(_)) {
            workspace.rows.pump_flow = workspace.situation.pump_flow;
        }
        if self.reads_metering_flows {
            self.contribute(workspace, parameters, state, |acts_on| acts_on == ActsOn::Valve);
            for (index, piston) in workspace.situation.pistons.iter_mut().enumerate() {
                piston.cap_flow = workspace.rows.cap_flow[index];
                piston.rod_flow = workspace.rows.rod_flow[index];
            }
            self.contribute(workspace, parameters, state, |acts_on| acts_on != ActsOn::Valve);
        } else {
            self.contribute(workspace, parameters, state, |_| true);
        }
        for &number in &self.remembering {
            self.remember_one(number, workspace, parameters, state, rates);
        }
        if self.layout.rod_forces.is_some() {
            self.assemble_rod_forces(workspace, state, rates);
        } else {
            self.assemble(workspace, rates);
        }
    }

    /// Adds the effects for which `wanted` returns true to the rows.
    fn contribute<T: Number>(
        &self,
        workspace: &mut Workspace<'m, T>,
        parameters: &[T],
        state: &[T],
        wanted: impl Fn(ActsOn) -> bool,
    ) {
        for (number, effect) in self.model.effects.iter().enumerate() {
            if wanted(effect.physics.card().acts_on) && !(self.as_printed && effect.physics.confines()) {
                self.contribute_one(number, workspace, parameters, state);
            }
        }
    }

    /// Adds one effect to the rows.
    pub(crate) fn contribute_one<T: Number>(
        &self,
        number: usize,
        workspace: &mut Workspace<'m, T>,
        parameters: &[T],
        state: &[T],
    ) {
        let effect = &self.model.effects[number];
        let own = &parameters[self.parameters_of(number)];
        let (hooks, Workspace { situation, rows, .. }) = (T::hooks(&*effect.physics), workspace);
        let states = self.states_of(number);
        if states.is_empty() {
            hooks.contribute(effect.site, own, situation, rows);
        } else {
            hooks.contribute_remembering(effect.site, own, &state[states], situation, rows);
        }
    }

    /// Writes the rates of one effect's memory, if it has any.
    pub(super) fn remember_one<T: Number>(
        &self,
        number: usize,
        workspace: &Workspace<'m, T>,
        parameters: &[T],
        state: &[T],
        rates: &mut [T],
    ) {
        let effect = &self.model.effects[number];
        if !effect.physics.has_memory() {
            return;
        }
        let (own, states) = (&parameters[self.parameters_of(number)], self.states_of(number));
        let rates = &mut rates[states.clone()];
        T::hooks(&*effect.physics).remember(effect.site, own, &state[states], &workspace.situation, rates);
    }

    fn parameters_of(&self, number: usize) -> Range<usize> {
        let (first, last) = self.parameter_ranges[number];
        first..last
    }

    fn states_of(&self, number: usize) -> Range<usize> {
        let (first, states) = self.layout.effect_states[number];
        first..first + states
    }

    /// Fills the situation: kinematics, pressures, and the spool after the effects that act on it, whose state rates are written
    /// to `rates`.
    pub fn observe<T: Number>(
        &self,
        workspace: &mut Workspace<'m, T>,
        parameters: &[T],
        state: &[T],
        inputs: &Inputs<T>,
        rates: &mut [T],
    ) {
        let layout = &self.layout;
        let situation = &mut workspace.situation;
        situation.time = inputs.time;
        situation.tank_pressure = inputs.tank_pressure;
        situation.pump_flow = inputs.pump_flow;
        situation.oil_temperature = inputs.oil_temperature;
        situation.pump_pressure = match layout.pump {
            Some(index) if self.model.imposed == Imposed::Nothing => state[index],
            _ => inputs.supply_pressure,
        };
        for (index, cylinder) in self.model.machine.cylinders.iter().enumerate() {
            let piston = &mut situation.pistons[index];
            (piston.joint, piston.rate) = if self.model.imposed == Imposed::Everything {
                (inputs.imposed[index].joint, inputs.imposed[index].rate)
            } else {
                (state[layout.joint(index)], state[layout.rate(index)])
            };
            piston.displacement = cylinder.linkage.displacement(piston.joint);
            piston.lever = cylinder.linkage.lever(piston.joint);
            piston.velocity = piston.lever * piston.rate;
            piston.rod_force = inputs.rod_force[index];
            if let Some(chambers) = &cylinder.chambers {
                if let (Some(cap), Some(rod)) = (layout.cap_pressure(index), layout.rod_pressure(index)) {
                    piston.cap_pressure = state[cap];
                    piston.rod_pressure = state[rod];
                }
                piston.cap_volume = chambers.cap_volume(cylinder.stroke, piston.displacement);
                piston.rod_volume = chambers.rod_volume(cylinder.stroke, piston.displacement);
            }
            if self.model.imposed == Imposed::Everything {
                piston.cap_pressure = inputs.imposed[index].cap_pressure;
                piston.rod_pressure = inputs.imposed[index].rod_pressure;
            }
            if cylinder.imposed_motion.is_some() {
                // The states follow the imposed motion; a deviating state returns to it.
                let imposed = &inputs.imposed[index];
                piston.cap_pressure = imposed.cap_pressure;
                piston.rod_pressure = imposed.rod_pressure;
                rates[layout.joint(index)] = imposed.rate + (imposed.joint - piston.joint) / self.tracking();
                rates[layout.rate(index)] = imposed.acceleration + (imposed.rate - piston.rate) / self.tracking();
            }
            piston.command = inputs.orifice_area[index];
            piston.spool = self.read(index, parameters, piston.command, inputs.orifice_rates[index]);
        }
        self.observe_valves(situation, parameters, state, rates);
    }

    /// Writes known motion and pressures to `state`: of each cylinder what `known` gives for its number, and the pump pressure, Pa,
    /// where the machine has a pump line. Effects' own states stay as they are.
    pub fn set_measured<T: Number>(&self, known: impl Fn(usize) -> KnownCylinder, pump_pressure: f64, state: &mut [T]) {
        let layout = &self.layout;
        for (number, cylinder) in self.model.machine.cylinders.iter().enumerate() {
            let KnownCylinder { joint, velocity, pressures } = known(number);
            state[layout.joint(number)] = T::from(joint);
            state[layout.rate(number)] = T::from(velocity / cylinder.linkage.lever(joint));
            if let (Some(cap), Some(rod)) = (layout.cap_pressure(number), layout.rod_pressure(number)) {
                state[cap] = T::from(pressures[0]);
                state[rod] = T::from(pressures[1]);
            }
        }
        if let Some(pump) = layout.pump {
            state[pump] = T::from(pump_pressure);
        }
    }

    /// Whether any effect has states of its own.
    pub fn has_effect_states(&self) -> bool {
        self.layout.effect_states.iter().any(|&(_, states)| states > 0)
    }

    /// Sets the effects' own states. Spools are set to the openings of these inputs (m², one per cylinder; missing ones are zero),
    /// settled or as measured. Other states take their initial values.
    pub fn set_effect_states(&self, openings: &[f64], state: &mut [f64]) {
        if !self.has_effect_states() {
            return;
        }
        let parameters = self.model.parameter_values();
        for number in 0..self.model.effects.len() {
            if let Site::Cylinder(cylinder) = self.model.effects[number].site {
                let spool = openings.get(cylinder).map_or(0.0, |&one| self.read(cylinder, &parameters, one, [0.0; 2]));
                state[self.states_of(number)].fill(spool);
            }
        }
        if self.remembering.is_empty() {
            return;
        }
        let mut inputs = Inputs::zero(self.layout.joints);
        for (slot, &area) in inputs.orifice_area.iter_mut().zip(openings) {
            *slot = area;
        }
        let (mut workspace, mut rates) = (self.workspace(), vec![0.0; self.layout.len]);
        self.observe(&mut workspace, &parameters, state, &inputs, &mut rates);
        for &number in &self.remembering {
            let effect = &self.model.effects[number];
            let own = &parameters[self.parameters_of(number)];
            let states = &mut state[self.states_of(number)];
            f64::hooks(&*effect.physics).begin(effect.site, own, &workspace.situation, states);
        }
    }

    /// The entries of [`System::state_scales`] that are not spools.
    pub fn law_states(&self) -> impl Iterator<Item = (usize, f64)> {
        let spans: Vec<_> = self.remembering.iter().map(|&number| self.states_of(number)).collect();
        self.state_scales().filter(move |(index, _)| spans.iter().any(|span| span.contains(index)))
    }

    /// Order of magnitude of each effect's own states: index in the state vector and magnitude in the state's unit.
    pub fn state_scales(&self) -> impl Iterator<Item = (usize, f64)> {
        let each = self.model.effects.iter().zip(&self.layout.effect_states);
        each.flat_map(|(effect, &(first, states))| {
            let size = self.model.machine.size_at(effect.site);
            // Memory has the unit of its law; every other state is an opening.
            let factor = if effect.physics.has_memory() { 1.0 } else { size.factor(Growth::OPENING) };
            (0..states).map(move |state| (first + state, factor * effect.physics.state_scale(state)))
        })
    }

    /// [`System::instruments`] at the model's own parameter values.
    pub fn own_instruments(&self) -> &Instruments<f64> {
        &self.own_instruments
    }

    /// Distortions of the model's instruments: sums of the effects that act on sensors. They do not depend on the state, so one
    /// evaluation per set of parameters is enough.
    pub fn instruments<T: Number>(&self, parameters: &[T]) -> Instruments<T> {
        let mut instruments = Instruments::true_ones(self.model.machine.cylinders.len());
        for (effect, &(first, last)) in self.model.effects.iter().zip(&self.parameter_ranges) {
            T::hooks(&*effect.physics).distort(effect.site, &parameters[first..last], &mut instruments);
        }
        instruments
    }

    /// Computes rates from rows: solves the mass matrix and divides flows by compliances.
    pub(super) fn assemble<T: Number>(&self, workspace: &mut Workspace<'m, T>, rates: &mut [T]) {
        let layout = &self.layout;
        let Workspace { situation, rows, mass, torque } = workspace;
        for (index, piston) in situation.pistons.iter().enumerate() {
            torque[index] = rows.driven_torque(index, situation);
            rates[layout.joint(index)] = piston.rate;
        }
        mass.copy_from_slice(&rows.mass);
        solve_symmetric(mass, torque);
        for (index, acceleration) in torque.iter().enumerate() {
            rates[layout.rate(index)] = *acceleration;
        }
        for (index, piston) in situation.pistons.iter().enumerate() {
            let Some(chambers) = situation.machine.cylinders[index].chambers else { continue };
            let (Some(cap), Some(rod)) = (layout.cap_pressure(index), layout.rod_pressure(index)) else { continue };
            rates[cap] = (rows.cap_flow[index] - piston.velocity * chambers.cap_area) / rows.cap_compliance[index];
            rates[rod] = (rows.rod_flow[index] + piston.velocity * chambers.rod_area) / rows.rod_compliance[index];
        }
        if let Some(pump) = layout.pump {
            rates[pump] = rows.pump_flow / rows.pump_line_compliance();
        }
        // States of measured signals are not used, and stay where they are.
        if self.model.imposed == Imposed::Everything {
            let held = 2 * layout.joints * if layout.chambers { 2 } else { 1 };
            rates[..held].fill(T::from(0.0));
            layout.pump.into_iter().for_each(|pump| rates[pump] = T::from(0.0));
        }
    }

    fn tracking(&self) -> f64 {
        TRACKING * self.size.time()
    }

    /// The force required by each imposed motion: inertia, less the forces of effects and pressures.
    fn assemble_rod_forces<T: Number>(&self, workspace: &Workspace<'m, T>, state: &[T], rates: &mut [T]) {
        let layout = &self.layout;
        let Workspace { situation, rows, .. } = workspace;
        let joints = layout.joints;
        for (index, piston) in situation.pistons.iter().enumerate() {
            let (Some(force), Some(imposed)) =
                (layout.rod_force(index), situation.machine.cylinders[index].imposed_motion)
            else {
                continue;
            };
            let mut torque = -rows.torque[index];
            for other in 0..joints {
                torque += rows.mass[index * joints + other] * rates[layout.rate(other)];
            }
            let pushed = imposed.pressure_force(piston.cap_pressure, piston.rod_pressure);
            let needed = torque / piston.lever - rows.piston_force[index] - pushed;
            rates[force] = (needed - state[force]) / self.tracking();
        }
    }
}

/// Time constant with which states return to an imposed motion and a force sensor follows, s: shorter than the sample intervals
/// of recordings, so that no measured signal is smoothed.
const TRACKING: f64 = 2e-3;

/// Solves the small symmetric positive definite system `matrix x = right` in place by elimination without pivoting, which is
/// stable for positive definite matrices. A custom solver, because it runs on dual numbers with a few entries each.
fn solve_symmetric<T: Number>(matrix: &mut [T], right: &mut [T]) {
    let order = right.len();
    for pivot in 0..order {
        let inverse = matrix[pivot * order + pivot].recip();
        for row in pivot + 1..order {
            let factor = matrix[row * order + pivot] * inverse;
            for column in pivot + 1..order {
                let above = matrix[pivot * order + column];
                matrix[row * order + column] -= factor * above;
            }
            let above = right[pivot];
            right[row] -= factor * above;
        }
    }
    for row in (0..order).rev() {
        let mut sum = right[row];
        for column in row + 1..order {
            sum -= matrix[row * order + column] * right[column];
        }
        right[row] = sum / matrix[row * order + row];
    }
}
