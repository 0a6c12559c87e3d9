//! External inputs of the model at one instant.

use crate::scalar::{Dual, Scalar, constant};

/// Motion and pressures imposed on one cylinder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ImposedState<T> {
    /// Joint coordinate q, rad (m for a linear load).
    pub joint: T,
    /// Its rate, rad/s (m/s).
    pub rate: T,
    /// Its acceleration, rad/s² (m/s²).
    pub acceleration: T,
    /// Cap side pressure p+, Pa.
    pub cap_pressure: T,
    /// Rod side pressure p-, Pa.
    pub rod_pressure: T,
}

impl<T> ImposedState<T> {
    /// Applies `of` to each number.
    pub fn each<U>(&self, of: impl Fn(&T) -> U) -> ImposedState<U> {
        ImposedState {
            joint: of(&self.joint),
            rate: of(&self.rate),
            acceleration: of(&self.acceleration),
            cap_pressure: of(&self.cap_pressure),
            rod_pressure: of(&self.rod_pressure),
        }
    }
}

/// Inputs of the model at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs<T> {
    /// Time since the first sample of the recording, s; for effects that act in a part of it only.
    pub time: T,
    /// Spool opening per cylinder: measured orifice area, or the commanded one where no spool sensor exists, m².
    pub orifice_area: Vec<T>,
    /// Rate of change of that opening before and after this instant, m²/s, per cylinder. The two differ at a sample,
    /// where the input has a kink. Zero unless an effect of the model needs it
    /// ([`crate::effects::Physics::reads_input_rate`]).
    pub orifice_rates: Vec<[T; 2]>,
    /// Force that drives the piston, per cylinder, N; used only by cylinders without chambers. It is measured on the rod;
    /// for an imposed motion it includes the force of the measured pressures.
    pub rod_force: Vec<T>,
    /// Imposed state of each cylinder; used only for imposed motions.
    pub imposed: Vec<ImposedState<T>>,
    /// Supply pressure in Pa; used only where the pump line is not a state.
    pub supply_pressure: T,
    /// Tank pressure pt, Pa.
    pub tank_pressure: T,
    /// Pump flow Qp, m³/s.
    pub pump_flow: T,
    /// Oil temperature, °C.
    pub oil_temperature: T,
}

/// Oil temperature where none is given, °C: usual for warm mobile hydraulics, and the one to which viscosities are stated.
pub const USUAL_OIL_TEMPERATURE: f64 = 40.0;

impl<T: Scalar> Inputs<T> {
    /// All inputs zero, for `cylinders` cylinders, with oil of [`USUAL_OIL_TEMPERATURE`].
    pub fn zero(cylinders: usize) -> Self {
        let zero = T::from(0.0);
        Inputs {
            time: zero,
            orifice_area: vec![zero; cylinders],
            orifice_rates: vec![[zero; 2]; cylinders],
            rod_force: vec![zero; cylinders],
            imposed: vec![
                ImposedState {
                    joint: zero,
                    rate: zero,
                    acceleration: zero,
                    cap_pressure: zero,
                    rod_pressure: zero
                };
                cylinders
            ],
            supply_pressure: zero,
            tank_pressure: zero,
            pump_flow: zero,
            oil_temperature: T::from(USUAL_OIL_TEMPERATURE),
        }
    }

    /// Copies the values of `other`, which has the same number of cylinders, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.time = other.time;
        self.orifice_area.copy_from_slice(&other.orifice_area);
        self.orifice_rates.copy_from_slice(&other.orifice_rates);
        self.rod_force.copy_from_slice(&other.rod_force);
        self.imposed.copy_from_slice(&other.imposed);
        self.supply_pressure = other.supply_pressure;
        self.tank_pressure = other.tank_pressure;
        self.pump_flow = other.pump_flow;
        self.oil_temperature = other.oil_temperature;
    }
}

impl Inputs<Dual> {
    /// Copies plain inputs as constants, without allocating.
    pub fn lift_from(&mut self, plain: &Inputs<f64>) {
        self.time = constant(plain.time);
        for (slot, &value) in self.orifice_area.iter_mut().zip(&plain.orifice_area) {
            *slot = constant(value);
        }
        for (slot, rates) in self.orifice_rates.iter_mut().zip(&plain.orifice_rates) {
            *slot = rates.map(constant);
        }
        for (slot, &value) in self.rod_force.iter_mut().zip(&plain.rod_force) {
            *slot = constant(value);
        }
        for (slot, plain) in self.imposed.iter_mut().zip(&plain.imposed) {
            *slot = plain.each(|&value| constant(value));
        }
        self.supply_pressure = constant(plain.supply_pressure);
        self.tank_pressure = constant(plain.tank_pressure);
        self.pump_flow = constant(plain.pump_flow);
        self.oil_temperature = constant(plain.oil_temperature);
    }
}
