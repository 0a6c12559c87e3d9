//! A simulated machine that advances sample by sample.

use super::{InputSignals, Integrator, SimulationError, Tolerances, reachable_rest_state, rest_state};
use crate::equations::{Inputs, System, Workspace};
use crate::machine::Supply;
use crate::recording::{CylinderSample, Recording, Sample};
use crate::{Model, SignalError};

/// Fraction of half a stroke at which a machine that left all bounds is restarted.
const INSIDE: f64 = 0.9;

/// A simulated machine whose commands are not known in advance.
#[derive(Debug)]
pub struct Plant<'m, 's> {
    system: &'s System<'m>,
    integrator: Integrator<'m, 's>,
    signals: InputSignals,
    inputs: Inputs<f64>,
    workspace: Workspace<'m, f64>,
    rates: Vec<f64>,
    parameters: Vec<f64>,
    state: Vec<f64>,
}

impl<'m, 's> Plant<'m, 's> {
    /// A machine at rest with these piston displacements (m), sampled every `period` seconds. `supply_pressure` (Pa) is that of
    /// an external supply; `None` for the machine's own.
    ///
    /// # Errors
    /// [`SignalError`] if the model needs an input that is not a command, or the linkage cannot reach a displacement.
    pub fn new(
        system: &'s System<'m>,
        displacements: &[f64],
        period: f64,
        supply_pressure: Option<f64>,
    ) -> Result<Self, SignalError> {
        let model = system.model();
        let signals = InputSignals::from_recording(model, &inputs_of_one_period(model, period, supply_pressure))?;
        let inputs = signals.at_start();
        let parameters = model.parameter_values();
        let integrator = Integrator::new(system, &parameters, &[], Tolerances::default());
        let state = reachable_rest_state(system, displacements, &inputs)?;
        let rates = vec![0.0; system.layout().len];
        let workspace = system.workspace();
        Ok(Plant { system, integrator, signals, inputs, workspace, rates, parameters, state })
    }

    /// Sets the valves (m², held for one period) and advances to the next sample.
    ///
    /// # Errors
    /// [`SimulationError`]; the machine is then at rest, near its last position.
    pub fn step(&mut self, areas: &[f64]) -> Result<(), SimulationError> {
        self.set_areas(areas);
        let outcome = self.integrator.advance(&self.signals, 0, &mut self.state, None);
        let outcome = outcome.and_then(|()| self.check());
        if outcome.is_err() {
            self.set_up_again();
        }
        outcome
    }

    /// The state as measured by ideal instruments; the caller sets the timestamp.
    pub fn sample(&mut self) -> Sample {
        self.signals.between(0, 0.0, &mut self.inputs);
        self.system.observe(&mut self.workspace, &self.parameters, &self.state, &self.inputs, &mut self.rates);
        let situation = &self.workspace.situation;
        let machine = &self.system.model().machine;
        let cylinders = machine.cylinders.iter().zip(&situation.pistons).map(|(cylinder, piston)| {
            let oil = cylinder.chambers.is_some();
            let with_oil = |value: f64| if oil { value } else { f64::NAN };
            CylinderSample {
                joint_angle: piston.joint,
                displacement: piston.displacement,
                velocity: piston.velocity,
                cap_pressure: with_oil(piston.cap_pressure),
                rod_pressure: with_oil(piston.rod_pressure),
                orifice_area: with_oil(piston.spool),
                rod_force: if oil { f64::NAN } else { piston.rod_force },
            }
        });
        let with_supply = |value: f64| if machine.supply == Supply::None { f64::NAN } else { value };
        let has_pump = matches!(machine.supply, Supply::PumpLine(_));
        Sample {
            nanoseconds: 0,
            cylinders: cylinders.collect(),
            pump_pressure: with_supply(situation.pump_pressure),
            tank_pressure: with_supply(situation.tank_pressure),
            pump_flow: if has_pump { situation.pump_flow } else { f64::NAN },
        }
    }

    /// Joint rates, rad/s or m/s, of the last [`Plant::sample`].
    pub fn joint_rates(&self) -> Vec<f64> {
        self.workspace.situation.pistons.iter().map(|piston| piston.rate).collect()
    }

    fn set_areas(&mut self, areas: &[f64]) {
        for (cylinder, &area) in areas.iter().enumerate().take(self.system.layout().joints) {
            self.signals.set_orifice_area(cylinder, 0, area);
            self.signals.set_orifice_area(cylinder, 1, area);
        }
    }

    fn check(&self) -> Result<(), SimulationError> {
        if self.state.iter().all(|value| value.is_finite()) {
            return Ok(());
        }
        let model = self.system.model();
        let state = self.system.layout().told(model, &self.state);
        Err(SimulationError::NotFinite { model: model.machine.name.clone(), time: 0.0, state })
    }

    fn set_up_again(&mut self) {
        let layout = self.system.layout();
        let displacements: Vec<f64> = self
            .system
            .model()
            .machine
            .cylinders
            .iter()
            .enumerate()
            .map(|(index, cylinder)| {
                let displacement = cylinder.linkage.displacement(self.state[layout.joint(index)]);
                let [retracted, extended] = cylinder.ends.map(|end| INSIDE * end);
                if displacement.is_finite() { displacement.clamp(retracted, extended) } else { 0.0 }
            })
            .collect();
        self.set_areas(&vec![0.0; displacements.len()]);
        self.signals.between(0, 0.0, &mut self.inputs);
        self.state = rest_state(self.system, &displacements, &self.inputs);
    }
}

/// A recording of two samples that has every input of the model; valve commands are set later, and the supply has the machine's
/// constants.
fn inputs_of_one_period(model: &Model, period: f64, supply_pressure: Option<f64>) -> Recording {
    let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    let mut recording = Recording::unmeasured("simulator", vec![0.0, period], &names);
    if let Some(pressure) = supply_pressure {
        recording.pump_pressure.fill(pressure);
    }
    for cylinder in &mut recording.cylinders {
        // A command, not a measured opening: it is held over the period.
        cylinder.orifice_command.fill(0.0);
        cylinder.rod_force.fill(0.0);
    }
    recording
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::document::built_in;

    #[test]
    fn an_open_valve_moves_the_piston_the_right_way() {
        let model = built_in("zx30u-arm").unwrap();
        let system = System::new(&model);
        let mut plant = Plant::new(&system, &[0.0], 1e-3, None).unwrap();
        let start = plant.sample().cylinders[0].displacement;
        for _ in 0..1000 {
            // Wide enough that the pump carries the load; with a smaller opening the arm sinks through the open centre.
            plant.step(&[1e-4]).unwrap();
        }
        let state = plant.sample();
        assert!(state.cylinders[0].displacement > start + 0.01, "{state:?}");
        assert_eq!(state.cylinders[0].orifice_area, 1e-4);
        assert!(state.cylinders[0].rod_force.is_nan());
    }

    #[test]
    fn every_built_in_model_runs() {
        for (name, _) in crate::document::BUILT_IN {
            let model = built_in(name).unwrap();
            let system = System::new(&model);
            let cylinders = model.machine.cylinders.len();
            let mut plant = Plant::new(&system, &vec![0.0; cylinders], 1e-3, Some(7e6)).unwrap();
            for _ in 0..200 {
                plant.step(&vec![0.0; cylinders]).unwrap();
            }
            assert!(plant.sample().cylinders.iter().all(|cylinder| cylinder.displacement.is_finite()), "{name}");
        }
    }

    #[test]
    fn a_displacement_out_of_reach_is_refused() {
        let model = built_in("zx30u-arm").unwrap();
        let system = System::new(&model);
        assert!(Plant::new(&system, &[3.0], 1e-3, None).is_err());
    }
}
