//! What the model is given from outside at one instant.

use crate::scalar::{Dual, Scalar, constant};

/// Inputs of the model at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Inputs<T> {
    /// Time since the first sample of the recording, s; for what is active in a part of it only.
    pub time: T,
    /// Spool opening per cylinder: measured orifice area, or the commanded one where no spool sensor exists, m².
    pub orifice_area: Vec<T>,
    /// Force measured on the rod, per cylinder, N; used only by cylinders without chambers.
    pub rod_force: Vec<T>,
    /// Supply pressure in Pa; used only where the pump line is not a state.
    pub supply_pressure: T,
    /// Tank pressure pt, Pa.
    pub tank_pressure: T,
    /// Pump flow Qp, m³/s.
    pub pump_flow: T,
}

impl<T: Scalar> Inputs<T> {
    /// All inputs zero, for `cylinders` cylinders.
    pub fn zero(cylinders: usize) -> Self {
        let zero = T::from(0.0);
        Inputs {
            time: zero,
            orifice_area: vec![zero; cylinders],
            rod_force: vec![zero; cylinders],
            supply_pressure: zero,
            tank_pressure: zero,
            pump_flow: zero,
        }
    }

    /// Takes over the values of `other`, which has as many cylinders, without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.time = other.time;
        self.orifice_area.copy_from_slice(&other.orifice_area);
        self.rod_force.copy_from_slice(&other.rod_force);
        self.supply_pressure = other.supply_pressure;
        self.tank_pressure = other.tank_pressure;
        self.pump_flow = other.pump_flow;
    }
}

impl Inputs<Dual> {
    /// Takes over plain inputs as constants, without allocating.
    pub fn lift_from(&mut self, plain: &Inputs<f64>) {
        self.time = constant(plain.time);
        for (slot, &value) in self.orifice_area.iter_mut().zip(&plain.orifice_area) {
            *slot = constant(value);
        }
        for (slot, &value) in self.rod_force.iter_mut().zip(&plain.rod_force) {
            *slot = constant(value);
        }
        self.supply_pressure = constant(plain.supply_pressure);
        self.tank_pressure = constant(plain.tank_pressure);
        self.pump_flow = constant(plain.pump_flow);
    }
}
