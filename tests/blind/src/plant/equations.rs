//! Equations of motion of the plant, \[A\] Eq. 1-3 with the errata of `docs/physics.md`, in plain `f64`.

use super::foreign::{BOOM_GRAVITY_MOMENT, BOOM_INERTIA, COUPLING, ENGINE_TIME, PISTON_MASS};
use super::friction::end_stop;
use super::geometry::{
    BOOM_ANGLE, CAP_AREA, GRAVITY, Geometry, MAXIMUM_OPENING, PUMP_FLOW, PUMP_VOLUME, ROD_AREA, TANK_PRESSURE,
    VAPOUR_PRESSURE, cap_volume, rod_volume,
};
use super::{Base, Effects, Extras};

/// Number of states.
pub const STATES: usize = 13;

/// Time constant with which the spool follows its command, s.
const SERVO: f64 = 0.012;
/// Pressure drop below which an orifice is laminar, Pa.
const LAMINAR: f64 = 2e3;

/// State of the plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Joint angle q2 (rad), its rate, cap, rod and pump pressure (Pa), spool (m²), two stages of a lag (m²), boom
    /// deflection (rad), its rate, piston displacement (m) and velocity where the pin has play, engine droop (rad/s²).
    pub values: [f64; STATES],
    /// Spool after play, m²: memory, not a differential state.
    pub played: f64,
}

/// A machine with everything that is hidden in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plant {
    /// Parameters of the nominal model.
    pub base: Base,
    /// What is hidden.
    pub effects: Effects,
    /// What is always there.
    pub extras: Extras,
    /// No spool sensor: the nominal model takes the command for the opening, and so does a plant without lag.
    pub blind_spool: bool,
    /// Length of the recording, s; events are placed in it.
    pub duration: f64,
    /// Gravity torque at the start that the boom's holding torque balances, N m.
    pub boom_holding_torque: f64,
}

/// Flows of one instant, m³/s, + = into the chamber or out of the pump line as named.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Flows {
    /// Opening of the metering edges, m².
    pub opening: f64,
    /// Through the valve block into the cap side: metering edges, valve leakage, secondary valves.
    pub cap: f64,
    /// Through the valve block into the rod side.
    pub rod: f64,
    /// From the pump line into the valve section.
    pub drawn: f64,
    /// From the pump line to tank through the open centre.
    pub bypass: f64,
    /// From the pump line through relief valve and pump leakage.
    pub lost: f64,
    /// Of the pump.
    pub pump: f64,
    /// Past the piston, cap to rod.
    pub internal: f64,
    /// To the outside from the cap side.
    pub external_cap: f64,
    /// To the outside from the rod side.
    pub external_rod: f64,
    /// Make-up into the cap side.
    pub make_up_cap: f64,
    /// Make-up into the rod side.
    pub make_up_rod: f64,
}

/// Forces on the piston of one instant, N.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forces {
    /// Of the chamber pressures.
    pub pressure: f64,
    /// Of all friction and losses.
    pub friction: f64,
    /// Of end stops and contact.
    pub outside: f64,
}

/// `sgn(x) sqrt|x|`; below 2 kPa the odd cubic that meets the root with its slope.
fn root(drop: f64) -> f64 {
    let size = drop.abs();
    if size >= LAMINAR {
        return drop.signum() * size.sqrt();
    }
    let share = drop / LAMINAR;
    LAMINAR.sqrt() * share * (1.25 - 0.25 * share * share)
}

impl Plant {
    /// Displacement (m) and velocity (m/s) of the piston.
    pub fn piston(&self, state: &State) -> (f64, f64) {
        if self.effects.foreign.pin_play > 0.0 {
            return (state.values[10], state.values[11]);
        }
        let geometry = Geometry::at(state.values[0]);
        (geometry.displacement, geometry.lever * state.values[1])
    }

    /// Spool position in m² that the sensor would see, before play and lag.
    pub fn spool(&self, state: &State, command: f64) -> f64 {
        match (self.effects.valve.lag, self.blind_spool) {
            (Some(lag), _) if lag.second > 0.0 => state.values[7],
            (Some(_), _) => state.values[6],
            (None, true) => command,
            (None, false) => state.values[5],
        }
    }

    /// A state at rest: chambers balance gravity, valve closed, pump line idle.
    pub fn at_rest(&self, displacement: f64) -> State {
        let joint = Geometry::joint(displacement);
        let lever = Geometry::at(joint).lever;
        let moment = self.base.gravity_moment + self.effects.load.gravity_moment(0.0, self.duration);
        let held = moment * GRAVITY * (BOOM_ANGLE + joint).sin() - self.effects.foreign.spring(joint);
        let force = held / lever;
        // The lighter loaded chamber stands 0.2 MPa above tank, as after a slow stroke.
        let floor = TANK_PRESSURE + 2e5;
        let cap = ((force + ROD_AREA * floor) / CAP_AREA).max(floor);
        let rod = (CAP_AREA * cap - force) / ROD_AREA;
        let idle = (PUMP_FLOW / (self.base.bypass_flow_gain * MAXIMUM_OPENING)).powi(2) + TANK_PRESSURE;
        let mut values = [0.0; STATES];
        values[0] = joint;
        values[2] = cap;
        values[3] = rod;
        values[4] = idle;
        values[10] = displacement + force.signum() * 0.5 * self.effects.foreign.pin_play;
        State { values, played: 0.0 }
    }

    /// Gravity torque on the boom's joint, N m, at a time in s.
    pub fn boom_gravity(&self, time: f64, boom: f64, joint: f64) -> f64 {
        let moment = self.base.gravity_moment + self.effects.load.gravity_moment(time, self.duration);
        GRAVITY * (BOOM_GRAVITY_MOMENT * boom.sin() + moment * (boom + joint).sin())
    }

    /// All flows at a state; `played` is the spool after play.
    pub fn flows(&self, time: f64, state: &State, played: f64) -> Flows {
        self.flows_with(time, state, played, self.piston(state).0)
    }

    /// The same where the displacement is known already.
    fn flows_with(&self, time: f64, state: &State, played: f64, displacement: f64) -> Flows {
        let [_, _, cap, rod, pump, ..] = state.values;
        let valve = &self.effects.valve;
        let mut opening = valve.opening(played);
        let inlet = if opening > 0.0 { cap } else { rod };
        let filter = |gain: f64| self.effects.foreign.before_filter(gain);
        let relief = 1.0 - self.effects.foreign.flow_force * (pump - inlet).abs() / 1e6;
        opening *= relief.max(0.2) * self.effects.foreign.gain_factor(time, self.duration);
        let (mut into_cap, mut into_rod, mut drawn);
        if opening >= 0.0 {
            drawn = valve.checked(valve.behind_hose(self.base.flow_gain_cap * opening) * root(pump - cap));
            into_cap = drawn;
            into_rod = -filter(valve.behind_hose(self.base.flow_gain_rod * opening)) * root(rod - TANK_PRESSURE);
        } else {
            let gain_cap = self.base.flow_gain_cap * (1.0 + valve.directional_cap);
            let gain_rod = self.base.flow_gain_rod * (1.0 + valve.directional_rod);
            drawn = valve.checked(valve.behind_hose(gain_rod * -opening) * root(pump - rod));
            into_rod = drawn;
            into_cap = filter(valve.behind_hose(gain_cap * opening)) * root(cap - TANK_PRESSURE);
        }
        let [pump_cap, cap_tank, pump_rod, rod_tank] = valve.leakage;
        let (leak_cap, leak_rod) = (pump_cap * (pump - cap), pump_rod * (pump - rod));
        drawn += leak_cap + leak_rod;
        into_cap += leak_cap - cap_tank * (cap - TANK_PRESSURE);
        into_rod += leak_rod - rod_tank * (rod - TANK_PRESSURE);
        into_cap -= self.effects.foreign.port_relief(cap);
        let travel = (played.abs() - self.effects.pump.bypass_overlap).max(0.0);
        let open_centre = (MAXIMUM_OPENING - travel).max(0.0);
        let droop = 1.0 - self.effects.foreign.engine_droop * state.values[12];
        Flows {
            opening,
            cap: into_cap,
            rod: into_rod,
            drawn,
            bypass: self.base.bypass_flow_gain * open_centre * root(pump - TANK_PRESSURE),
            lost: self.effects.pump.relief(pump) + self.effects.pump.leakage * pump,
            pump: PUMP_FLOW * self.extras.pump_factor(time) * droop.max(0.5),
            internal: (self.base.internal_leakage + self.effects.foreign.leakage(displacement)) * (cap - rod),
            external_cap: self.base.external_leakage_cap * cap,
            external_rod: self.base.external_leakage_rod * rod,
            make_up_cap: self.effects.oil.make_up(cap),
            make_up_rod: self.effects.oil.make_up(rod),
        }
    }

    /// All forces on the piston at a state.
    pub fn forces(&self, time: f64, state: &State) -> Forces {
        self.forces_with(time, state, self.piston(state))
    }

    /// The same where displacement and velocity are known already.
    fn forces_with(&self, time: f64, state: &State, (displacement, velocity): (f64, f64)) -> Forces {
        let [_, _, cap, rod, ..] = state.values;
        let foreign = &self.effects.foreign;
        let viscous = self.base.viscous_damping
            * self.extras.damping_factor(time)
            * foreign.damping_factor(time, self.duration)
            * velocity;
        let direction = self.extras.reversal.direction(velocity);
        let dry = (self.base.coulomb_friction + foreign.bump(displacement)) * direction;
        Forces {
            pressure: CAP_AREA * cap - ROD_AREA * rod,
            friction: -viscous - dry + self.effects.friction.force(displacement, velocity, direction, [cap, rod]),
            outside: end_stop(displacement, velocity) + self.effects.load.contact(time, self.duration),
        }
    }

    /// Time derivative of the state. `command` and `late_command` (m²) are the command now and before a lag's delay.
    pub fn rates(&self, time: f64, state: &State, command: f64, late_command: f64) -> [f64; STATES] {
        let [joint, joint_rate, cap, rod, _, spool, first, second, deflection, deflection_rate, ..] = state.values;
        let geometry = Geometry::at(joint);
        let (displacement, velocity) = if self.effects.foreign.pin_play > 0.0 {
            (state.values[10], state.values[11])
        } else {
            (geometry.displacement, geometry.lever * joint_rate)
        };
        // Play moves once per step, a lag within it.
        let played = if self.effects.valve.hysteresis > 0.0 { state.played } else { self.spool(state, command) };
        let flows = self.flows_with(time, state, played, displacement);
        let forces = self.forces_with(time, state, (displacement, velocity));
        let force = forces.pressure + forces.friction + forces.outside;
        let mut rates = [0.0; STATES];

        let on_arm = if self.effects.foreign.pin_play > 0.0 {
            let pin = self
                .effects
                .foreign
                .pin_force(displacement - geometry.displacement, velocity - geometry.lever * joint_rate);
            rates[10] = velocity;
            rates[11] = (force - pin) / PISTON_MASS;
            pin
        } else {
            force
        };
        let inertia = self.base.inertia + self.effects.load.inertia(time, self.duration);
        let moment = self.base.gravity_moment + self.effects.load.gravity_moment(time, self.duration);
        let boom = BOOM_ANGLE + deflection;
        let torque =
            geometry.lever * on_arm - moment * GRAVITY * (boom + joint).sin() + self.effects.foreign.spring(joint);
        rates[0] = joint_rate;
        if self.effects.foreign.boom_compliance > 0.0 {
            let stiffness = 1.0 / self.effects.foreign.boom_compliance;
            // 3 % of critical damping.
            let damping = 0.06 * (stiffness * BOOM_INERTIA).sqrt();
            let (sine, cosine) = joint.sin_cos();
            let (m11, m12) = (BOOM_INERTIA + 2.0 * COUPLING * cosine, inertia + COUPLING * cosine);
            let holding = self.boom_holding_torque - stiffness * deflection - damping * deflection_rate;
            let turning = COUPLING * sine * (2.0 * deflection_rate + joint_rate) * joint_rate;
            let on_boom = holding - self.boom_gravity(time, boom, joint) + turning;
            let on_joint = torque - COUPLING * sine * deflection_rate * deflection_rate;
            let determinant = m11 * inertia - m12 * m12;
            rates[8] = deflection_rate;
            rates[9] = (inertia * on_boom - m12 * on_joint) / determinant;
            rates[1] = (m11 * on_joint - m12 * on_boom) / determinant;
        } else {
            rates[1] = torque / inertia;
        }

        let compliance = |volume: f64, pressure: f64| {
            let oil = 1.0 / self.base.bulk_modulus + self.effects.oil.bubble_compressibility(pressure);
            volume * oil + self.extras.hose_compliance
        };
        let cap_net = flows.cap + flows.make_up_cap - flows.internal - flows.external_cap - CAP_AREA * velocity;
        let rod_net = flows.rod + flows.make_up_rod + flows.internal - flows.external_rod + ROD_AREA * velocity;
        rates[2] = cap_net / compliance(cap_volume(displacement), cap);
        rates[3] = rod_net / compliance(rod_volume(displacement), rod);
        rates[4] = (flows.pump - flows.drawn - flows.bypass - flows.lost) * self.base.pump_bulk_modulus / PUMP_VOLUME;

        rates[5] = (command - spool) / SERVO;
        if let Some(lag) = self.effects.valve.lag {
            rates[6] = (late_command - first) / lag.first;
            if lag.second > 0.0 {
                rates[7] = (first - second) / lag.second;
            }
        }
        rates[12] = (rates[1].abs().min(2.0) - state.values[12]) / ENGINE_TIME;
        rates
    }

    /// What cannot be written as a rate: play of the valve, and oil that boils instead of stretching.
    pub fn settle(&self, state: &mut State, command: f64) {
        state.played = self.effects.valve.play(state.played, self.spool(state, command));
        for pressure in &mut state.values[2..5] {
            *pressure = pressure.max(VAPOUR_PRESSURE);
        }
    }
}
