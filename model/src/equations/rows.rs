//! The rows of the equations of motion, as sums that effects add to.

use super::Situation;
use crate::scalar::{Dual, Scalar};

/// Sums of the effects' contributions. Pressure forces `A+ p+ - A- p-` and the oil displaced by the piston `A v` belong to the
/// machine itself and are not included.
///
/// The equations are `mass qdd = torque + G (piston_force + A+ p+ - A- p-)`,
/// `cap_compliance dp+/dt = cap_flow - A+ v`, `rod_compliance dp-/dt = rod_flow + A- v`,
/// `(pump_compliance + accumulator_compliance) dpp/dt = pump_flow` (with the pump's own flow Qp in `pump_flow`).
#[derive(Debug, Clone, PartialEq)]
pub struct Rows<T> {
    joints: usize,
    /// Mass matrix, row-major, kg m² (kg for a linear load).
    pub mass: Vec<T>,
    /// Torque on each joint, N m (N).
    pub torque: Vec<T>,
    /// Force on each piston, + = pushes the rod out, N.
    pub piston_force: Vec<T>,
    /// Flow into the cap side chamber, m³/s.
    pub cap_flow: Vec<T>,
    /// Flow into the rod side chamber, m³/s.
    pub rod_flow: Vec<T>,
    /// Volume times compressibility of the cap side, m³/Pa.
    pub cap_compliance: Vec<T>,
    /// Volume times compressibility of the rod side, m³/Pa.
    pub rod_compliance: Vec<T>,
    /// Flow into the pump line, m³/s.
    pub pump_flow: T,
    /// Volume times compressibility of the pump line, m³/Pa.
    pub pump_compliance: T,
    /// Compliance of the pump line besides its oil, m³/Pa: gas behind a bladder.
    pub accumulator_compliance: T,
}

impl<T: Scalar> Rows<T> {
    /// All sums zero.
    pub fn zero(joints: usize) -> Self {
        let zero = T::from(0.0);
        Rows {
            joints,
            mass: vec![zero; joints * joints],
            torque: vec![zero; joints],
            piston_force: vec![zero; joints],
            cap_flow: vec![zero; joints],
            rod_flow: vec![zero; joints],
            cap_compliance: vec![zero; joints],
            rod_compliance: vec![zero; joints],
            pump_flow: zero,
            pump_compliance: zero,
            accumulator_compliance: zero,
        }
    }

    /// Resets every sum to zero without allocating.
    pub fn clear(&mut self) {
        let zero = T::from(0.0);
        for sums in [
            &mut self.mass,
            &mut self.torque,
            &mut self.piston_force,
            &mut self.cap_flow,
            &mut self.rod_flow,
            &mut self.cap_compliance,
            &mut self.rod_compliance,
        ] {
            sums.fill(zero);
        }
        self.pump_flow = zero;
        self.pump_compliance = zero;
        self.accumulator_compliance = zero;
    }

    /// Total compliance of the pump line, m³/Pa.
    pub fn pump_line_compliance(&self) -> T {
        self.pump_compliance + self.accumulator_compliance
    }

    /// Adds to the mass matrix at (`row`, `column`).
    pub fn add_mass(&mut self, row: usize, column: usize, value: T) {
        self.mass[row * self.joints + column] += value;
    }

    /// The mass matrix at (`row`, `column`).
    pub fn mass_at(&self, row: usize, column: usize) -> T {
        self.mass[row * self.joints + column]
    }

    /// Torque on a joint including that of its cylinder (from the pressures in the chambers or the force measured on the rod), N
    /// m (N). It accelerates the joint.
    pub fn driven_torque(&self, joint: usize, situation: &Situation<'_, T>) -> T {
        let piston = &situation.pistons[joint];
        let drive = match situation.chambers(joint) {
            Some(chambers) => chambers.pressure_force(piston.cap_pressure, piston.rod_pressure),
            None => piston.rod_force,
        };
        self.torque[joint] + piston.lever * (self.piston_force[joint] + drive)
    }

    /// Number of joints.
    pub fn joints(&self) -> usize {
        self.joints
    }
}

impl Rows<Dual> {
    /// Copies the values of `totals` and keeps its own derivatives.
    pub(super) fn set_values(&mut self, totals: &Rows<Dual>) {
        let sums = [
            (&mut self.mass, &totals.mass),
            (&mut self.torque, &totals.torque),
            (&mut self.piston_force, &totals.piston_force),
            (&mut self.cap_flow, &totals.cap_flow),
            (&mut self.rod_flow, &totals.rod_flow),
            (&mut self.cap_compliance, &totals.cap_compliance),
            (&mut self.rod_compliance, &totals.rod_compliance),
        ];
        for (own, totals) in sums {
            own.iter_mut().zip(totals).for_each(|(own, total)| own.re = total.re);
        }
        self.pump_flow.re = totals.pump_flow.re;
        self.pump_compliance.re = totals.pump_compliance.re;
        self.accumulator_compliance.re = totals.accumulator_compliance.re;
    }
}
