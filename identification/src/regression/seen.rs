//! Data that a regression derives from a recording before it solves for parameters.

use excavator_model::Model;
use excavator_model::effects::Effect;
use excavator_model::recording::Recording;
use excavator_model::simulation::undistorted;

use super::sensor_noise::{SensorNoise, sensor_noise};
use super::simulated::{Simulated, simulated};
use super::{Observation, RegressionError, observe_guided};

/// One recording as a model sees it.
pub(crate) struct Seen {
    pub(super) noise: SensorNoise,
    pub(super) observation: Observation,
    pub(super) simulation: Simulated,
}

impl Seen {
    /// Removes noise from the measured signals relative to `guide`, or relative to the simulation of the model if there
    /// is no guide.
    ///
    /// # Errors
    /// [`RegressionError`] if inputs or initial states are missing.
    pub(super) fn of(model: &Model, recording: &Recording, guide: Option<&Recording>) -> Result<Self, RegressionError> {
        let noise = sensor_noise(recording, model)?;
        let truth = undistorted(model, recording);
        let simulation = simulated(model, recording, &truth)?;
        let observation = observe_guided(model, &truth, guide.unwrap_or(&simulation.recording))?;
        Ok(Seen { noise, observation, simulation })
    }
}

/// Recordings as one model sees them, for the first regression of models with one more effect.
pub(crate) struct Ground {
    /// The recordings.
    pub recordings: Vec<Recording>,
    pub(super) seen: Vec<Seen>,
}

impl Ground {
    /// The recordings as `model` sees them.
    ///
    /// # Errors
    /// [`RegressionError`] if inputs or initial states are missing.
    pub fn new(model: &Model, recordings: Vec<Recording>) -> Result<Self, RegressionError> {
        let seen = recordings.iter().map(|recording| Seen::of(model, recording, None)).collect::<Result<_, _>>()?;
        Ok(Ground { recordings, seen })
    }

    /// Whether the data stay valid for a model with this additional effect. They do not if the effect has states of its
    /// own, or changes the meaning of instruments or of the input.
    pub fn holds_for(effect: &dyn Effect) -> bool {
        effect.states() == 0 && Ground::keeps_signals(effect)
    }

    /// Whether the measured signals mean the same with this additional effect.
    pub fn keeps_signals(effect: &dyn Effect) -> bool {
        !effect.reads_input_rate() && !effect.is_an_instruments()
    }
}
