//! The values that effects can read.

use super::Rounding;
use super::inputs::USUAL_OIL_TEMPERATURE;
use super::smooth::{LAMINAR_PRESSURE, at_most};
use super::warmth::{Oil, Warmth};
use crate::effects::Site;
use crate::machine::{Chambers, Machine, Size};
use crate::scalar::{Dual, Scalar, constant};

/// State of one cylinder and its joint at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piston<T> {
    /// Joint coordinate q, rad (m for a linear load).
    pub joint: T,
    /// Its rate, rad/s (m/s).
    pub rate: T,
    /// Piston displacement s from mid-stroke, m.
    pub displacement: T,
    /// Piston velocity v, m/s.
    pub velocity: T,
    /// Lever G = ds/dq, m.
    pub lever: T,
    /// Cap side pressure p+, Pa; zero without chambers, unless the motion is imposed.
    pub cap_pressure: T,
    /// Rod side pressure p-, Pa.
    pub rod_pressure: T,
    /// Cap side volume V+, m³; one without chambers, so that nothing divides by zero.
    pub cap_volume: T,
    /// Rod side volume V-, m³.
    pub rod_volume: T,
    /// Valve input of the recording as an orifice area, m²: measured, or commanded if there is no spool sensor.
    pub command: T,
    /// Flow of the valve's effects into the cap side, m³/s; set only if an effect of the model needs it
    /// ([`crate::effects::Physics::reads_metering_flows`]).
    pub cap_flow: T,
    /// The same into the rod side.
    pub rod_flow: T,
    /// True spool position as an orifice area, m²: the input after lag and hysteresis.
    pub spool: T,
    /// Area open to flow, m²: the spool position after dead zone and area law. It sets the metered flow.
    pub opening: T,
    /// Opening of the edge from the pump line, m²; equals `opening` unless an effect treats the edges differently.
    pub supply_opening: T,
    /// Opening of the edge to the tank, m²; likewise.
    pub return_opening: T,
    /// Closing of the section's bypass, m²: |spool|, less the overlap of the bypass.
    pub bypass_closing: T,
    /// Fraction of the backflow from the chamber to the pump that passes the valve section: 1 without a check valve.
    pub backflow: T,
    /// Pressure drop that a compensator keeps across the edges fed by the pump, Pa; `None` without one.
    pub compensator_margin: Option<T>,
    /// Pressure loss per squared flow in each hose between valve and chamber, Pa s²/m⁶; `None` without hoses.
    pub hose_resistance: Option<T>,
    /// How the corners of friction and of flow are rounded.
    pub rounding: Rounding<T>,
    /// What the temperature does to the oil and the seals of this cylinder.
    pub warmth: Warmth<T>,
    /// Force that drives a cylinder without chambers, N: measured on the rod; for an imposed motion it includes the pressure
    /// force.
    pub rod_force: T,
}

impl<T> Piston<T> {
    /// Applies `of` to each number.
    pub fn each<U>(&self, of: impl Fn(&T) -> U) -> Piston<U> {
        Piston {
            joint: of(&self.joint),
            rate: of(&self.rate),
            displacement: of(&self.displacement),
            velocity: of(&self.velocity),
            lever: of(&self.lever),
            cap_pressure: of(&self.cap_pressure),
            rod_pressure: of(&self.rod_pressure),
            cap_volume: of(&self.cap_volume),
            rod_volume: of(&self.rod_volume),
            command: of(&self.command),
            cap_flow: of(&self.cap_flow),
            rod_flow: of(&self.rod_flow),
            spool: of(&self.spool),
            opening: of(&self.opening),
            supply_opening: of(&self.supply_opening),
            return_opening: of(&self.return_opening),
            bypass_closing: of(&self.bypass_closing),
            backflow: of(&self.backflow),
            compensator_margin: self.compensator_margin.as_ref().map(&of),
            hose_resistance: self.hose_resistance.as_ref().map(&of),
            rounding: self.rounding.each(&of),
            warmth: self.warmth.each(&of),
            rod_force: of(&self.rod_force),
        }
    }
}

impl<T: Scalar> Piston<T> {
    /// `sgn(v)`, rounded as for friction.
    pub fn direction(&self) -> T {
        self.rounding.sign(self.velocity)
    }

    /// Friction of seals at the temperature of the oil, N, of one that is `force` at the usual temperature.
    pub fn rubbing(&self, force: T) -> T {
        self.warmth.seal_friction.map_or(force, |factor| force * factor)
    }

    /// Openings of the edges at the cap and at the rod side, m², with the sign of the motion. An opening that an effect reduces
    /// below zero counts as closed.
    pub fn edges(&self) -> [T; 2] {
        let extends = self.opening.value() >= 0.0;
        let shut = |opening: T| if (opening.value() >= 0.0) == extends { opening } else { T::from(0.0) };
        let (supply, back) = (shut(self.supply_opening), shut(self.return_opening));
        if extends { [supply, back] } else { [back, supply] }
    }

    /// Gain of an edge (m³/(s sqrt(Pa))) in series with its hose.
    pub fn with_hose(&self, gain: T) -> T {
        self.hose_resistance.map_or(gain, |resistance| gain / (resistance * gain * gain + 1.0).sqrt())
    }

    /// `phi` of a pressure drop (Pa) over one of the valve's edges.
    pub fn root(&self, pressure_drop: T) -> T {
        self.rounding.root(pressure_drop)
    }

    /// `phi` of the pressure drop (Pa) from pump to chamber over a metering edge, limited by a compensator and by the permitted
    /// backflow.
    pub fn drawn_root(&self, pressure_drop: T) -> T {
        let root = self.root(self.compensator_margin.map_or(pressure_drop, |margin| at_most(pressure_drop, margin)));
        if pressure_drop.value() < 0.0 { root * self.backflow } else { root }
    }
}

/// All values that effects can read, at one instant.
#[derive(Debug, Clone)]
pub struct Situation<'m, T> {
    /// The machine.
    pub machine: &'m Machine,
    /// Its unit of time relative to the reference machine ([`crate::machine::Size::time`]), a pure number.
    pub time_scale: f64,
    /// Time since the first sample of the recording, s.
    pub time: T,
    /// One entry per cylinder.
    pub pistons: Vec<Piston<T>>,
    /// Pump or supply pressure pp, Pa.
    pub pump_pressure: T,
    /// Pressure drop below which the flow of the bypass is laminar, Pa.
    pub bypass_transition: f64,
    /// Tank pressure pt, Pa.
    pub tank_pressure: T,
    /// Pump flow Qp, m³/s.
    pub pump_flow: T,
    /// Oil temperature, °C.
    pub oil_temperature: T,
    /// What the temperature does to the oil of the pump line.
    pub pump_oil: Oil<T>,
}

impl<'m, T: Scalar> Situation<'m, T> {
    /// A situation with all values zero, to be filled.
    pub fn empty(machine: &'m Machine) -> Self {
        let zero = T::from(0.0);
        let piston = Piston {
            joint: zero,
            rate: zero,
            displacement: zero,
            velocity: zero,
            lever: zero,
            cap_pressure: zero,
            rod_pressure: zero,
            cap_volume: T::from(1.0),
            rod_volume: T::from(1.0),
            command: zero,
            cap_flow: zero,
            rod_flow: zero,
            spool: zero,
            opening: zero,
            supply_opening: zero,
            return_opening: zero,
            bypass_closing: zero,
            backflow: T::from(1.0),
            compensator_margin: None,
            hose_resistance: None,
            rounding: Rounding::of_the_equations(&Size::REFERENCE),
            warmth: Warmth::USUAL,
            rod_force: zero,
        };
        Situation {
            machine,
            time_scale: machine.size().time(),
            time: zero,
            pistons: vec![piston; machine.cylinders.len()],
            pump_pressure: zero,
            bypass_transition: LAMINAR_PRESSURE,
            tank_pressure: zero,
            pump_flow: zero,
            oil_temperature: T::from(USUAL_OIL_TEMPERATURE),
            pump_oil: Oil::USUAL,
        }
    }

    /// Largest input of a cylinder's drive, umax, m² or its own unit; zero without chambers.
    pub fn largest_opening(&self, site: Site) -> f64 {
        let Site::Cylinder(cylinder) = site else { return 0.0 };
        self.chambers(cylinder).map_or(0.0, |chambers| chambers.full_command())
    }

    /// Known constants of a cylinder's chambers; `None` for a cylinder driven by a measured force.
    pub fn chambers(&self, cylinder: usize) -> Option<&'m Chambers> {
        self.machine.cylinders.get(cylinder).and_then(|c| c.chambers.as_ref())
    }
}

impl Situation<'_, Dual> {
    /// Copies the values of `other`, which belongs to the same machine, as constants.
    pub(super) fn hold(&mut self, other: &Self) {
        let held = |number: &Dual| constant(number.re);
        self.time = held(&other.time);
        for (own, piston) in self.pistons.iter_mut().zip(&other.pistons) {
            *own = piston.each(held);
        }
        self.pump_pressure = held(&other.pump_pressure);
        self.tank_pressure = held(&other.tank_pressure);
        self.pump_flow = held(&other.pump_flow);
        self.oil_temperature = held(&other.oil_temperature);
        self.pump_oil = other.pump_oil.each(held);
    }
}
