//! Runs one model under commands.

use excavator_model::Model;
use excavator_model::SignalError;
use excavator_model::equations::{Channel, System, USUAL_OIL_TEMPERATURE};
use excavator_model::machine::Supply;
use excavator_model::recording::Recording;
use excavator_model::simulation::{
    InputSignals, Integrator, Observer, Profile, Segment, SimulationError, Tolerances, reachable_rest_state,
};

use super::DesignError;
use super::limits::Extremes;

/// A model prepared to run from one state to another.
pub(super) struct Rider<'m> {
    pub system: System<'m>,
    parameters: Vec<f64>,
}

/// Result of a run.
#[derive(Debug, Clone)]
pub(super) struct Ride {
    /// Noise-free readings of the instruments.
    pub recording: Recording,
    /// State at the last sample, in the order of the model's layout.
    pub end: Vec<f64>,
    /// Extremes of the true states, not of the readings.
    pub extremes: Extremes,
}

impl<'m> Rider<'m> {
    pub fn new(model: &'m Model) -> Self {
        Rider { system: System::new(model), parameters: model.parameter_values() }
    }

    /// State at rest with closed valves at these piston displacements, m.
    ///
    /// # Errors
    /// [`SignalError::NoInitialState`] if the linkage cannot reach a displacement.
    pub fn at_rest(&self, displacements: &[f64]) -> Result<Vec<f64>, SignalError> {
        let recording = self.commanded(&[], 0.0, 0.01, 2);
        let signals = InputSignals::from_recording(self.system.model(), &recording)?;
        reachable_rest_state(&self.system, displacements, &signals.at_start())
    }

    /// Piston displacement of a cylinder in a state, m.
    pub fn displacement(&self, cylinder: usize, state: &[f64]) -> f64 {
        Channel::Displacement(cylinder).value(&self.system, state)
    }

    /// Runs one cylinder's segments from `state` at time `from` s, with all other valves closed.
    ///
    /// # Errors
    /// [`DesignError::Simulation`], [`DesignError::Signal`].
    pub fn run(
        &self,
        cylinder: usize,
        segments: &[Segment],
        state: Vec<f64>,
        from: f64,
        rate: f64,
    ) -> Result<Ride, DesignError> {
        let name = self.system.model().machine.cylinders[cylinder].name.clone();
        self.run_profiles(&[Profile { cylinder: name, segments: segments.to_vec() }], state, from, rate)
    }

    /// Runs profiles of several cylinders from `state` at time `from` s, sampled `rate` times per second.
    ///
    /// # Errors
    /// [`DesignError::Simulation`], [`DesignError::Signal`].
    pub fn run_profiles(
        &self,
        profiles: &[Profile],
        mut state: Vec<f64>,
        from: f64,
        rate: f64,
    ) -> Result<Ride, DesignError> {
        let duration = profiles.iter().map(Profile::duration).fold(0.0, f64::max);
        let samples = (duration * rate).round() as usize + 1;
        let mut recording = self.commanded(profiles, from, 1.0 / rate, samples);
        let model = self.system.model();
        let signals = InputSignals::from_recording(model, &recording)?;
        let channels = Channel::all(self.system.layout());
        let mut integrator = Integrator::new(&self.system, &self.parameters, &[], Tolerances::default());
        let mut observer = Observer::new(&self.system, &self.parameters, &[], &channels);
        let mut extremes = Extremes::none(model.machine.cylinders.len());
        for index in 0..signals.len() {
            observer.record(&signals, index, &state, &mut recording);
            self.see(&channels, &state, &mut extremes);
            if index + 1 < signals.len() {
                let advanced: Result<(), SimulationError> = integrator.advance(&signals, index, &mut state, None);
                advanced?;
            }
        }
        Ok(Ride { recording, end: state, extremes })
    }

    fn see(&self, channels: &[Channel], state: &[f64], extremes: &mut Extremes) {
        for &channel in channels {
            match channel {
                Channel::Displacement(cylinder) => {
                    extremes.see_displacement(cylinder, channel.value(&self.system, state));
                }
                Channel::CapPressure(_) | Channel::RodPressure(_) | Channel::PumpPressure => {
                    extremes.see_pressure(channel.value(&self.system, state));
                }
                Channel::JointAngle(_) | Channel::Velocity(_) | Channel::RodForce(_) => {}
            }
        }
    }

    /// A recording that contains only commands and supply, on a clock from `from` s.
    fn commanded(&self, profiles: &[Profile], from: f64, interval: f64, samples: usize) -> Recording {
        let machine = &self.system.model().machine;
        let names: Vec<&str> = machine.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect();
        let time: Vec<f64> = (0..samples).map(|index| from + index as f64 * interval).collect();
        let mut recording = Recording::unmeasured(&machine.name, time, &names);
        match machine.supply {
            Supply::PumpLine(line) => {
                recording.tank_pressure.fill(line.tank_pressure);
                recording.pump_flow.fill(line.flow);
            }
            Supply::PressureSource(source) => {
                recording.tank_pressure.fill(source.tank_pressure);
                recording.pump_pressure.fill(source.pressure);
            }
            Supply::None => {}
        }
        recording.oil_temperature.fill(USUAL_OIL_TEMPERATURE);
        Profile::command(profiles, &mut recording);
        recording
    }
}
