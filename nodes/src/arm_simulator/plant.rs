//! The model, stepped from sample to sample.

use excavator_model::equations::{Inputs, System, Workspace};
use excavator_model::machine::Supply;
use excavator_model::recording::Recording;
use excavator_model::simulation::{InputSignals, Integrator, SimulationError, Tolerances, rest_state};
use excavator_model::{Model, SignalError};
use excavator_msgs::{ArmState, CylinderState, Header};

/// Share of half a stroke at which a machine that left all bounds is set up again.
const INSIDE: f64 = 0.9;

/// A machine at work.
pub(super) struct Plant<'m, 's> {
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
    /// A machine at rest with these piston displacements (m), sampled every `period` seconds.
    ///
    /// # Errors
    /// [`SignalError`] when the model needs an input that a simulator cannot give.
    pub fn new(
        system: &'s System<'m>,
        displacements: &[f64],
        period: f64,
        supply_pressure: f64,
    ) -> Result<Self, SignalError> {
        let model = system.model();
        let signals = InputSignals::from_recording(model, &inputs_of_one_period(model, period, supply_pressure))?;
        let mut inputs = Inputs::zero(model.machine.cylinders.len());
        signals.between(0, 0.0, &mut inputs);
        let parameters = model.parameter_values();
        let integrator = Integrator::new(system, &parameters, &[], Tolerances::default());
        let state = rest_state(system, displacements, &inputs);
        if let Some(index) = (0..system.layout().joints).find(|&index| !state[system.layout().joint(index)].is_finite())
        {
            let cylinder = &model.machine.cylinders[index];
            let displacement = displacements.get(index).copied().unwrap_or_default();
            return Err(SignalError::NoInitialState {
                source_name: model.machine.name.clone(),
                signal: format!("{}.displacement", cylinder.name),
                reason: format!("the linkage cannot reach {displacement} m; change start_displacement"),
            });
        }
        let rates = vec![0.0; system.layout().len];
        let workspace = system.workspace();
        Ok(Plant { system, integrator, signals, inputs, workspace, rates, parameters, state })
    }

    /// Sets the valves (m², held for one period) and goes on to the next sample.
    ///
    /// # Errors
    /// [`SimulationError`]; the machine is at rest then, near where it was.
    pub fn step(&mut self, areas: &[f64]) -> Result<(), SimulationError> {
        self.set_areas(areas);
        let outcome = self.integrator.advance(&self.signals, 0, &mut self.state, None);
        let outcome = outcome.and_then(|()| self.check());
        if outcome.is_err() {
            self.set_up_again();
        }
        outcome
    }

    /// The state, as perfect instruments see it; stamped by the caller.
    pub fn observe(&mut self, oil_temperature: f64) -> ArmState {
        self.signals.between(0, 0.0, &mut self.inputs);
        self.system.observe(&mut self.workspace, &self.parameters, &self.state, &self.inputs, &mut self.rates);
        let situation = &self.workspace.situation;
        let machine = &self.system.model().machine;
        let cylinders = machine
            .cylinders
            .iter()
            .zip(&situation.pistons)
            .map(|(cylinder, piston)| {
                let oil = cylinder.chambers.is_some();
                let with_oil = |value: f64| if oil { value } else { f64::NAN };
                CylinderState {
                    name: cylinder.name.clone(),
                    joint_angle: piston.joint,
                    displacement: piston.displacement,
                    velocity: piston.velocity,
                    cap_pressure: with_oil(piston.cap_pressure),
                    rod_pressure: with_oil(piston.rod_pressure),
                    orifice_area: with_oil(piston.spool),
                    rod_force: if oil { f64::NAN } else { piston.rod_force },
                }
            })
            .collect();
        let supplied = machine.supply != Supply::None;
        let with_supply = |value: f64| if supplied { value } else { f64::NAN };
        let has_pump = matches!(machine.supply, Supply::PumpLine(_));
        ArmState {
            header: Header::default(),
            cylinders,
            pump_pressure: with_supply(situation.pump_pressure),
            tank_pressure: with_supply(situation.tank_pressure),
            pump_flow: if has_pump { situation.pump_flow } else { f64::NAN },
            oil_temperature,
        }
    }

    /// Joint rates, rad/s or m/s, of the state observed last.
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
                let most = INSIDE * cylinder.stroke / 2.0;
                if displacement.is_finite() { displacement.clamp(-most, most) } else { 0.0 }
            })
            .collect();
        self.set_areas(&vec![0.0; displacements.len()]);
        self.signals.between(0, 0.0, &mut self.inputs);
        self.state = rest_state(self.system, &displacements, &self.inputs);
    }
}

/// A recording of two samples that has every input of the model; the valves are set later.
fn inputs_of_one_period(model: &Model, period: f64, supply_pressure: f64) -> Recording {
    let names: Vec<&str> = model.machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
    let mut recording = Recording::unmeasured("simulator", vec![0.0, period], &names);
    if supply_pressure > 0.0 {
        recording.pump_pressure.fill(supply_pressure);
    }
    if let Supply::PressureSource(source) = model.machine.supply {
        recording.tank_pressure.fill(source.tank_pressure);
    }
    if let Supply::PumpLine(line) = model.machine.supply {
        recording.tank_pressure.fill(line.tank_pressure);
        recording.pump_flow.fill(line.flow);
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
    use excavator_model::document::built_in;

    #[test]
    fn an_open_valve_moves_the_piston_the_right_way() {
        let model = built_in("zx30u-arm").unwrap();
        let system = System::new(&model);
        let mut plant = Plant::new(&system, &[0.0], 1e-3, 0.0).unwrap();
        let start = plant.observe(27.0).cylinders[0].displacement;
        for _ in 0..1000 {
            // Wide enough that the pump carries the load; with less the arm sinks back through the open centre.
            plant.step(&[1e-4]).unwrap();
        }
        let state = plant.observe(27.0);
        assert!(state.cylinders[0].displacement > start + 0.01, "{state:?}");
        assert_eq!(state.cylinders[0].orifice_area, 1e-4);
        assert!(state.cylinders[0].rod_force.is_nan());
    }

    #[test]
    fn every_built_in_model_runs() {
        for (name, _) in excavator_model::document::BUILT_IN {
            let model = built_in(name).unwrap();
            let system = System::new(&model);
            let cylinders = model.machine.cylinders.len();
            let mut plant = Plant::new(&system, &vec![0.0; cylinders], 1e-3, 7e6).unwrap();
            for _ in 0..200 {
                plant.step(&vec![0.0; cylinders]).unwrap();
            }
            assert!(plant.observe(27.0).cylinders.iter().all(|cylinder| cylinder.displacement.is_finite()), "{name}");
        }
    }

    #[test]
    fn a_displacement_out_of_reach_is_refused() {
        let model = built_in("zx30u-arm").unwrap();
        let system = System::new(&model);
        assert!(Plant::new(&system, &[3.0], 1e-3, 0.0).is_err());
    }
}
