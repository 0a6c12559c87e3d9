//! Small oscillations of a machine at rest: oil columns against link inertia.

use crate::Model;
use crate::equations::{Inputs, System};
use crate::machine::Supply;
use crate::simulation::{Linearisation, reachable_rest_state};

/// An oscillation of small amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Oscillation {
    /// Natural frequency, Hz.
    pub frequency: f64,
    /// Damping ratio; negative if the oscillation grows.
    pub damping: f64,
}

/// The oscillations about rest at mid-stroke with all valves closed, slowest first. Empty if nothing oscillates or the machine
/// cannot rest there.
pub fn oscillations(model: &Model) -> Vec<Oscillation> {
    let system = System::new(model);
    let mut inputs = Inputs::zero(model.machine.cylinders.len());
    inputs.tank_pressure = model.machine.supply.tank_pressure();
    inputs.pump_flow = model.machine.supply.pump_flow();
    if let Supply::PressureSource(source) = model.machine.supply {
        inputs.supply_pressure = source.pressure;
    }
    let middle = vec![0.0; model.machine.cylinders.len()];
    let Ok(rest) = reachable_rest_state(&system, &middle, &inputs) else { return Vec::new() };
    let mut linearisation = Linearisation::new(&system, &[]);
    linearisation.evaluate(&system, &model.parameter_values(), &rest, &inputs);
    if linearisation.by_state.iter().any(|slope| !slope.is_finite()) {
        return Vec::new();
    }
    let mut found: Vec<Oscillation> = linearisation
        .by_state
        .complex_eigenvalues()
        .iter()
        .filter(|root| root.im > 0.0)
        .map(|root| Oscillation { frequency: root.norm() / std::f64::consts::TAU, damping: -root.re / root.norm() })
        .collect();
    found.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    found
}
